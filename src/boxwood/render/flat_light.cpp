#include "boxwood/render/flat_light.h"

#include "boxwood/core/every_cpu.h"

namespace boxwood::render {

#define BOXWOOD_LOOPS "boxwood/render/flat_light-inl.h"
#include "boxwood/core/every_cpu-inl.h"

void sample_flat_lights(const std::vector<FlatLight>& lights, const Integers& index,
                        const Floats& probability, const SurfaceBlock& from, const Vec2s& u,
                        LightSamples& out) {
  const auto loop = BOXWOOD_BEST(sample_flat_block);
  loop(lights.data(), index, probability, from, u, out);
}

}  // namespace boxwood::render
