// block.h: how are many points worked on at once?
//
// A block holds a fixed number of points, each of their quantities in an array of its own. Loops over all of
// a block, made of arithmetic and selects without branches, are what compilers turn into vector instructions;
// the fixed length leaves no remainder. Such loops stand in files *-inl.h and are compiled for several
// processors (core/every_cpu-inl.h). Places of a block that no point fills hold whatever was there before.
#pragma once

#include <array>
#include <cstdint>

#include "boxwood/core/ray.h"

namespace boxwood {

/// Small enough for all arrays of a step to lie in the nearest cache.
inline constexpr int kBlock = 32;

using Floats = std::array<float, kBlock>;
using Integers = std::array<std::uint32_t, kBlock>;

struct Vec2s {
  Floats x{}, y{};

  Vec2 operator[](int i) const { return {x[i], y[i]}; }
  void set(int i, Vec2 v) {
    x[i] = v.x;
    y[i] = v.y;
  }
};

struct Vec3s {
  Floats x{}, y{}, z{};

  Vec3 operator[](int i) const { return {x[i], y[i], z[i]}; }
  void set(int i, Vec3 v) {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
};

/// Rays that start at t = 0.
struct RayBlock {
  Vec3s origin, direction;
  Floats t_max{};

  Ray operator[](int i) const { return {origin[i], 0, direction[i], t_max[i]}; }
  void set(int i, const Ray& ray) {
    origin.set(i, ray.origin);
    direction.set(i, ray.direction);
    t_max[i] = ray.t_max;
  }
};

}  // namespace boxwood
