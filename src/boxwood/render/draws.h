// draws.h: which numbers will many samples draw next?
//
// A draw is integer arithmetic without a branch, so a block of samples (block.h) draws by vectors; each gets
// the numbers that its own sampler would give it (sampler.h).
#pragma once

#include "boxwood/core/block.h"
#include "boxwood/render/sampler.h"

namespace boxwood::render {

class Draws {
 public:
  static constexpr int kAhead = 4;

  /// Takes note of the sampler of point `i`.
  void set(int i, const Sampler& sampler) {
    pixel_seed_[i] = sampler.pixel_seed_;
    reversed_index_[i] = sampler.reversed_index_;
    dimension_[i] = sampler.dimension_;
  }
  /// Works out the next `count` draws of all points.
  void draw(int count = kAhead);

  /// What the `k`-th of these would be.
  Vec2 pair(int i, int k) const { return pairs_[k][i]; }

 private:
  Integers pixel_seed_{}, reversed_index_{}, dimension_{};
  std::array<Vec2s, kAhead> pairs_;
};

}  // namespace boxwood::render
