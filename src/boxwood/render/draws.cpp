#include "boxwood/render/draws.h"

#include "boxwood/core/every_cpu.h"

namespace boxwood::render {

#define BOXWOOD_LOOPS "boxwood/render/draws-inl.h"
#include "boxwood/core/every_cpu-inl.h"

void Draws::draw(int count) {
  const auto loop = BOXWOOD_BEST(draw_block);
  for (int k = 0; k < count; ++k)
    loop(pixel_seed_, reversed_index_, dimension_, static_cast<std::uint32_t>(k), pairs_[k]);
}

}  // namespace boxwood::render
