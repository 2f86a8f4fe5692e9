// The law of boxes: no bound is above that of a box inside, and no box that a ray really meets is missed.
#include "boxwood/core/prepared_ray.h"

#include <gtest/gtest.h>

#include "boxwood/core/random.h"

namespace boxwood {
namespace {

float power(Random& random, int lowest, int highest) {
  return std::ldexp(random.uniform(1, 2), lowest + int(random.below(std::uint32_t(highest - lowest))));
}

/// A number to trip over: zeros of both signs, ones, powers, or anything in between.
float tricky(Random& random, float scale) {
  switch (random.below(8)) {
    case 0:
      return 0.0f;
    case 1:
      return -0.0f;
    case 2:
      return scale;
    case 3:
      return -scale;
    case 4:
      return scale * power(random, -40, 0);
    default:
      return random.uniform(-scale, scale);
  }
}

Vec3 tricky_point(Random& random, float scale) {
  const float x = tricky(random, scale), y = tricky(random, scale), z = tricky(random, scale);
  return {x, y, z};
}

Box3 tricky_box(Random& random, float scale) {
  Box3 box;
  box.extend(tricky_point(random, scale));
  if (random.below(10) != 0) box.extend(tricky_point(random, scale));
  if (random.below(4) == 0) {  // flat
    const int axis = static_cast<int>(random.below(3));
    box.upper[axis] = box.lower[axis];
  }
  return box;
}

/// A ray near `box`: from a face, an edge, a corner or anywhere;
/// along an axis, at a corner, into a face or anywhere.
Ray tricky_ray(Random& random, const Box3& box, float scale, float direction_scale) {
  Ray ray;
  ray.origin = tricky_point(random, scale * (random.below(2) ? 1.0f : 3.0f));
  for (int k = 0; k < 3; ++k)
    if (random.below(4) == 0) ray.origin[k] = random.below(2) ? box.lower[k] : box.upper[k];
  if (random.below(3) == 0) {
    // At a corner, an edge or a face, as well as floats can aim.
    Vec3 target = random.in_box(box.lower, box.upper);
    for (int k = 0; k < 3; ++k)
      if (random.below(2)) target[k] = random.below(2) ? box.lower[k] : box.upper[k];
    ray.direction = (target - ray.origin) * (direction_scale / scale);
  } else {
    ray.direction = tricky_point(random, direction_scale);
  }
  return ray;
}

/// Where the line is inside the box, in long double: the real numbers, as far as floats can tell.
struct ExactInterval {
  long double entry = -INFINITY, exit = INFINITY;
  bool is_empty() const { return !(entry <= exit); }
};

ExactInterval exact_interval(const Ray& ray, const Box3& box) {
  ExactInterval out;
  for (int k = 0; k < 3; ++k) {
    const long double o = ray.origin[k], d = ray.direction[k];
    if (d == 0) {
      if (o < box.lower[k] || o > box.upper[k]) return {1, -1};
      continue;
    }
    const long double a = (box.lower[k] - o) / d, b = (box.upper[k] - o) / d;
    out.entry = std::max(out.entry, std::min(a, b));
    out.exit = std::min(out.exit, std::max(a, b));
  }
  return out;
}

void expect_conservative(const Ray& ray, const Box3& box, const Box3& bounds, std::uint64_t& hits) {
  const PreparedRay prepared(ray, bounds);
  if (!prepared.is_valid()) return;
  const ExactInterval exact = exact_interval(ray, box);
  if (exact.is_empty()) return;
  ++hits;
  const Interval found = prepared.interval(box);
  ASSERT_TRUE(found.entry <= float(exact.entry) && found.exit >= float(exact.exit))
      << "origin (" << ray.origin.x << ", " << ray.origin.y << ", " << ray.origin.z << "), direction ("
      << ray.direction.x << ", " << ray.direction.y << ", " << ray.direction.z << "), box (" << box.lower.x
      << ", " << box.lower.y << ", " << box.lower.z << ") to (" << box.upper.x << ", " << box.upper.y << ", "
      << box.upper.z << "): [" << found.entry << ", " << found.exit << "] does not hold [" << exact.entry
      << ", " << exact.exit << "]";
  if (exact.exit >= 0) {
    ASSERT_LE(prepared.bound(box), float(std::max(exact.entry, 0.0L)));
  }
}

TEST(PreparedRay, MissesNoBoxThatTheRayMeets) {
  Random random(1);
  std::uint64_t hits = 0;
  for (int i = 0; i < 3'000'000; ++i) {
    const float scale = power(random, -8, 8);
    const Box3 box = tricky_box(random, scale);
    const Box3 bounds = unite(box, tricky_box(random, scale));
    expect_conservative(tricky_ray(random, box, scale, random.below(2) ? 1.0f : power(random, -20, 20)), box,
                        bounds, hits);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(hits, 500'000u);
}

TEST(PreparedRay, MissesNoBoxAtAnyScale) {
  Random random(2);
  std::uint64_t hits = 0;
  for (int i = 0; i < 2'000'000; ++i) {
    const float scale = random.below(3) == 0 ? 1e30f : random.below(2) ? 1e-30f : power(random, -120, 120);
    const float direction_scale = power(random, -95, 95);
    const Box3 box = tricky_box(random, scale);
    const Box3 bounds = unite(box, tricky_box(random, scale));
    expect_conservative(tricky_ray(random, box, scale, direction_scale), box, bounds, hits);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(hits, 200'000u);
}

TEST(PreparedRay, TheBoundOfABoxIsAtMostThatOfAnyBoxInside) {
  Random random(3);
  for (int i = 0; i < 2'000'000; ++i) {
    const float scale = random.below(4) == 0 ? power(random, -120, 120) : 1.0f;
    // Nested boxes, each larger on some sides only; sometimes the innermost one is empty.
    Box3 boxes[4];
    if (random.below(20) != 0) boxes[0] = tricky_box(random, scale);
    for (int k = 1; k < 4; ++k) boxes[k] = unite(boxes[k - 1], tricky_box(random, scale));
    const float direction_scale = random.below(4) == 0 ? power(random, -95, 95) : 1.0f;
    Ray ray = tricky_ray(random, boxes[1], scale, direction_scale);
    if (random.below(2)) ray.t_min = random.uniform();
    const PreparedRay prepared(ray, boxes[3]);
    if (!prepared.is_valid()) continue;
    for (int k = 1; k < 4; ++k) {
      ASSERT_LE(prepared.bound(boxes[k]), prepared.bound(boxes[k - 1]));
      const Interval inner = prepared.interval(boxes[k - 1]), outer = prepared.interval(boxes[k]);
      ASSERT_FALSE(std::isnan(outer.entry) || std::isnan(outer.exit));
      ASSERT_TRUE(inner.is_empty() || (outer.entry <= inner.entry && outer.exit >= inner.exit));
    }
  }
}

TEST(PreparedRay, AnEmptyBoxIsNeverEntered) {
  const Box3 bounds{splat(-10), splat(10)};
  for (const Vec3 d : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{1, 2, -3}, Vec3{-0.0f, 0, 1}}) {
    const PreparedRay ray({.origin = {1, 2, 3}, .direction = d}, bounds);
    EXPECT_EQ(ray.bound(Box3{}), kInfinity);
    EXPECT_TRUE(ray.interval(Box3{}).is_empty());
  }
}

TEST(PreparedRay, FarBoxesAreCulled) {
  // Conservative must not mean useless.
  Random random(4);
  const Box3 bounds{splat(-10), splat(10)};
  int exact_misses = 0, culled = 0;
  for (int i = 0; i < 200'000; ++i) {
    Box3 box;
    box.extend(random.in_box(bounds.lower, bounds.upper));
    box.extend(box.lower + random.in_box(splat(0), splat(1)));
    const Ray ray{.origin = random.in_box(bounds.lower, bounds.upper), .direction = random.direction()};
    const bool misses = exact_interval(ray, box).is_empty();
    exact_misses += misses;
    culled += misses && PreparedRay(ray, bounds).interval(box).is_empty();
  }
  EXPECT_GT(culled, exact_misses - exact_misses / 10'000 - 5);
}

TEST(PreparedRay, BoundIsWhereTheRayEnters) {
  const Box3 bounds{splat(-10), splat(10)}, box{{2, -1, -1}, {3, 1, 1}};
  const auto bound = [&](Ray ray) { return PreparedRay(ray, bounds).bound(box); };
  EXPECT_NEAR(bound({.origin = {0, 0, 0}, .direction = {1, 0, 0}}), 2, 1e-4);
  EXPECT_NEAR(bound({.origin = {0, 0, 0}, .direction = {4, 0, 0}}), 0.5, 1e-4);
  EXPECT_EQ(bound({.origin = {2.5f, 0, 0}, .direction = {1, 0, 0}}), 0) << "inside";
  EXPECT_EQ(bound({.origin = {0, 0, 0}, .t_min = 2.5f, .direction = {1, 0, 0}}), 2.5f);
  EXPECT_EQ(bound({.origin = {0, 0, 0}, .t_min = 3.5f, .direction = {1, 0, 0}}), kInfinity);
  EXPECT_EQ(bound({.origin = {0, 0, 0}, .direction = {-1, 0, 0}}), kInfinity) << "behind";
  EXPECT_EQ(bound({.origin = {0, 5, 0}, .direction = {1, 0, 0}}), kInfinity) << "beside";
  EXPECT_LE(bound({.origin = {0, 1, 0}, .direction = {1, -0.0f, 0}}), 2) << "in the plane of a face";
  EXPECT_LE(bound({.origin = {2, 1, 1}, .direction = {0, 0, -1}}), 0) << "along an edge, from a corner";
  EXPECT_LT(bound({.origin = {0, 0, 0}, .t_min = -5, .direction = {1, 0, 0}}), 2.001f)
      << "t_min below 0 counts as 0";
  EXPECT_EQ(bound({.origin = {4, 0, 0}, .t_min = -5, .direction = {1, 0, 0}}), kInfinity);
}

TEST(PreparedRay, ABadRayIsNotValid) {
  const Box3 bounds{splat(-1), splat(1)};
  const auto is_valid = [&](Ray ray) { return PreparedRay(ray, bounds).is_valid(); };
  const Ray good{.origin = {0, 0, 0}, .direction = {0, 0, 1}};
  const float nan = std::nanf("");
  EXPECT_TRUE(is_valid(good));
  for (int k = 0; k < 3; ++k)
    for (const float bad : {nan, kInfinity, -kInfinity}) {
      Ray ray = good;
      ray.origin[k] = bad;
      EXPECT_FALSE(is_valid(ray));
      ray = good;
      ray.direction[k] = bad;
      EXPECT_FALSE(is_valid(ray));
    }
  const auto with = [&](auto change) {
    Ray ray = good;
    change(ray);
    return is_valid(ray);
  };
  EXPECT_FALSE(with([](Ray& r) { r.direction = {0, -0.0f, 0}; }));
  EXPECT_FALSE(with([](Ray& r) { r.direction = splat(0x1p-97f); }));
  EXPECT_TRUE(with([](Ray& r) { r.direction = {0, 0x1p-96f, 0}; }));
  EXPECT_TRUE(with([](Ray& r) { r.direction = {0, 0, -0x1p96f}; }));
  EXPECT_FALSE(with([](Ray& r) { r.direction = splat(0x1p97f); }));
  EXPECT_FALSE(with([&](Ray& r) { r.t_min = nan; }));
  EXPECT_FALSE(with([&](Ray& r) { r.t_max = nan; }));
  EXPECT_FALSE(with([](Ray& r) { r.t_min = 2, r.t_max = 1; }));
  EXPECT_FALSE(with([](Ray& r) { r.t_max = -1; }));
  EXPECT_TRUE(with([](Ray& r) { r.t_min = r.t_max = 1; }));
}

TEST(PreparedRay, TheShearMakesTheRayTheZAxis) {
  Random random(5);
  for (int i = 0; i < 10'000; ++i) {
    const Vec3 d = tricky_point(random, 1);
    const PreparedRay ray({.direction = d}, {splat(-1), splat(1)});
    if (!ray.is_valid()) continue;
    EXPECT_EQ(std::fabs(d[ray.axis_z]), max_component(abs(d)));
    EXPECT_NE(ray.axis_x, ray.axis_y);
    EXPECT_EQ(ray.axis_x + ray.axis_y + ray.axis_z, 3);
    EXPECT_LE(std::fabs(ray.shear_x), 1.000001f);
    EXPECT_LE(std::fabs(ray.shear_y), 1.000001f);
    EXPECT_NEAR(ray.shear_z * d[ray.axis_z], 1, 1e-6);
  }
}

}  // namespace
}  // namespace boxwood
