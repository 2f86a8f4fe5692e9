#include "boxwood/render/draws.h"

namespace boxwood::render {

#define BOXWOOD_LOOPS "boxwood/render/draws-inl.h"
#include "boxwood/core/every_cpu-inl.h"

void Draws::draw() {
  const auto loop = has_avx2() ? avx2::draw_block : everywhere::draw_block;
  for (int k = 0; k < kAhead; ++k)
    loop(pixel_seed_, reversed_index_, dimension_, static_cast<std::uint32_t>(k), pairs_[k]);
}

}  // namespace boxwood::render
