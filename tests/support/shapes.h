// shapes.h: which shapes do the tests throw together?
//
// For each kind: a random shape of a given size near a point, a shape with corners on integer coordinates (so
// that rays meet edges, planes and ties exactly), and a degenerate one.
#pragma once

#include "boxwood/core/random.h"
#include "boxwood/shape/cuboid.h"
#include "boxwood/shape/disk.h"
#include "boxwood/shape/quad.h"
#include "boxwood/shape/sphere.h"

namespace boxwood::test {

template <class Shape>
struct Make;

inline Vec3 lattice_point(Random& random, int n = 4) {
  const auto pick = [&] { return float(int(random.below(static_cast<std::uint32_t>(2 * n + 1))) - n); };
  const float x = pick(), y = pick(), z = pick();
  return {x, y, z};
}

template <>
struct Make<Triangle> {
  static Triangle random(Random& r, Vec3 near, float size) {
    const auto corner = [&] { return near + r.in_box(splat(-1), splat(1)) * size; };
    const Vec3 a = corner(), b = corner(), c = corner();
    return {a, b, c};
  }
  static Triangle lattice(Random& r) {
    const Vec3 a = lattice_point(r), b = lattice_point(r), c = lattice_point(r);
    return {a, b, c};
  }
  static Triangle degenerate(Random& r) {
    Triangle t = lattice(r);
    if (r.below(2)) t.c = t.b * 2.0f - t.a;  // a line
    if (r.below(2)) t.b = t.a;
    return t;
  }
};

template <>
struct Make<Quad> {
  static Quad random(Random& r, Vec3 near, float size) {  // bent
    const Triangle t = Make<Triangle>::random(r, near, size);
    return {t.a, t.b, t.c, t.a + (t.c - t.b) + r.in_box(splat(-0.2f), splat(0.2f)) * size};
  }
  static Quad lattice(Random& r) {  // flat, in an axis-aligned plane
    const Vec3 a = lattice_point(r);
    const int axis = static_cast<int>(r.below(3));
    Vec3 u, v;
    u[(axis + 1) % 3] = float(1 + r.below(3));
    v[(axis + 2) % 3] = float(1 + r.below(3));
    return {a, a + u, a + u + v, a + v};
  }
  static Quad degenerate(Random& r) {
    Quad q = lattice(r);
    if (r.below(2)) q.d = q.a;
    if (r.below(2)) q.c = q.b;
    return q;
  }
};

template <>
struct Make<Sphere> {
  static Sphere random(Random& r, Vec3 near, float size) {
    const Vec3 center = near + r.in_box(splat(-1), splat(1)) * size;
    return {center, size * r.uniform(0.1f, 1)};
  }
  static Sphere lattice(Random& r) {
    const Vec3 center = lattice_point(r);
    return {center, float(1 + r.below(3))};
  }
  static Sphere degenerate(Random& r) {
    const Vec3 center = lattice_point(r);
    return {center, r.below(2) ? 0.0f : -1.0f};
  }
};

template <>
struct Make<Cuboid> {
  static Cuboid random(Random& r, Vec3 near, float size) {
    const Vec3 a = near + r.in_box(splat(-1), splat(1)) * size,
               b = near + r.in_box(splat(-1), splat(1)) * size;
    return {min(a, b), max(a, b)};
  }
  static Cuboid lattice(Random& r) {
    const Vec3 a = lattice_point(r), b = lattice_point(r);
    return {min(a, b), max(a, b)};
  }
  static Cuboid degenerate(Random& r) {
    Cuboid c = lattice(r);
    const int axis = static_cast<int>(r.below(3));
    // Flat, or inside out: not there.
    c.upper[axis] = c.lower[axis] - (r.below(2) ? 0.0f : 1.0f);
    return c;
  }
};

template <>
struct Make<Disk> {
  static Disk random(Random& r, Vec3 near, float size) {
    const Vec3 center = near + r.in_box(splat(-1), splat(1)) * size, facing = r.direction();
    return {center, facing, size * r.uniform(0.1f, 1)};
  }
  static Disk lattice(Random& r) {
    const Vec3 center = lattice_point(r);
    Vec3 facing{0, 0, 0};
    facing[static_cast<int>(r.below(3))] = 2;
    return {center, facing, float(1 + r.below(3))};
  }
  static Disk degenerate(Random& r) {
    Disk d = lattice(r);
    if (r.below(2)) d.radius = 0;
    if (r.below(2)) d.facing = {0, 0, 0};
    return d;
  }
};

/// `count` shapes of mixed size in [-1, 1]^3: sizes spread evenly over the magnitudes from 1 down to 1e-3.
template <class Shape>
std::vector<Shape> random_shapes(int count, std::uint64_t seed, float scale = 1, Vec3 offset = {}) {
  Random random(seed);
  std::vector<Shape> shapes;
  for (int i = 0; i < count; ++i) {
    const Vec3 near = random.in_box(splat(-1), splat(1));
    const float size = std::pow(10.0f, random.uniform(-3, 0));
    shapes.push_back(Make<Shape>::random(random, near * scale + offset, size * scale));
  }
  return shapes;
}

template <class Shape>
std::vector<Shape> lattice_shapes(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Shape> shapes;
  for (int i = 0; i < count; ++i) shapes.push_back(Make<Shape>::lattice(random));
  return shapes;
}

/// Half of them degenerate, so that there is something to hit.
template <class Shape>
std::vector<Shape> degenerate_shapes(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Shape> shapes;
  for (int i = 0; i < count; ++i)
    shapes.push_back(i % 2 ? Make<Shape>::degenerate(random) : Make<Shape>::lattice(random));
  return shapes;
}

/// The same shape again and again.
template <class Shape>
std::vector<Shape> coincident_shapes(int count, std::uint64_t seed) {
  Random random(seed);
  return std::vector<Shape>(static_cast<std::size_t>(count), Make<Shape>::random(random, {0, 0, 0}, 1));
}

}  // namespace boxwood::test
