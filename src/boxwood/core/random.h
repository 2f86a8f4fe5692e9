// random.h: where do repeatable random numbers come from?
//
// PCG32 (O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random
// Number Generation", 2014): the same numbers on every machine, which std:: distributions do not promise.
#pragma once

#include "boxwood/core/vec.h"

namespace boxwood {

class Random {
 public:
  /// Different (seed, stream) pairs give unrelated sequences.
  explicit Random(std::uint64_t seed = 0, std::uint64_t stream = 0) : state_(0), increment_(2 * stream + 1) {
    next();
    state_ += seed;
    next();
  }

  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ull + increment_;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto turn = static_cast<std::uint32_t>(old >> 59);
    return (shifted >> turn) | (shifted << ((32 - turn) & 31));
  }
  /// In [0, n); n > 0. The bias, below n / 2^32, does not matter for what it is used for.
  std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>((std::uint64_t(next()) * n) >> 32);
  }
  /// In [0, 1).
  float uniform() { return static_cast<float>(next() >> 8) * 0x1p-24f; }
  float uniform(float a, float b) { return a + (b - a) * uniform(); }
  Vec3 in_box(Vec3 a, Vec3 b) {
    const float x = uniform(a.x, b.x), y = uniform(a.y, b.y), z = uniform(a.z, b.z);
    return {x, y, z};
  }
  /// Uniform on the unit sphere.
  Vec3 direction() {
    const float z = uniform(-1, 1), phi = uniform(0, 6.28318530718f), r = std::sqrt(max(0.0f, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::uint64_t state_, increment_;
};

}  // namespace boxwood
