// triangle_test.cpp: exact signs, the rule for ties, and where t comes from.
#include "boxwood/shape/triangle.h"

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

PreparedRay line(Vec3 origin, Vec3 direction) {
  return {origin, direction, -kInfinity, kInfinity, Box3{splat(-100), splat(100)}};
}

bool crosses(const Triangle& triangle, Vec3 origin, Vec3 direction) {
  Crossing crossing;
  return intersect_triangle(line(origin, direction), triangle.a, triangle.b, triangle.c, crossing);
}

TEST(Triangle, GivesTAndWeights) {
  Crossing crossing;
  ASSERT_TRUE(
      intersect_triangle(line({0.25f, 0.5f, 3}, {0, 0, -2}), {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, crossing));
  EXPECT_EQ(crossing.t, 1);
  EXPECT_EQ(crossing.u, 0.25f);
  EXPECT_EQ(crossing.v, 0.5f);
  EXPECT_FALSE(crosses({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {0.6f, 0.6f, 3}, {0, 0, -1}));
}

// A fan around a vertex covers all directions around it:
// a ray exactly through the vertex crosses one triangle.
TEST(Triangle, AVertexOfAFanIsCrossedOnce) {
  Random random(1);
  for (int corners = 3; corners < 12; ++corners)
    for (int i = 0; i < 200; ++i) {
      std::vector<Vec3> ring;
      for (int k = 0; k < corners; ++k) {
        const float angle = 6.2831853f * (float(k) + random.uniform(0, 0.4f)) / float(corners);
        ring.push_back({std::cos(angle), std::sin(angle), random.uniform(-0.1f, 0.1f)});
      }
      for (const Vec3 direction : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{0.25f, 0.125f, 1}}) {
        int count = 0;
        for (std::size_t k = 0; k < ring.size(); ++k)
          count += crosses({{0, 0, 0}, ring[k], ring[(k + 1) % ring.size()]}, direction * -2.0f, direction);
        EXPECT_EQ(count, 1);
      }
    }
}

// On both sides of an edge stands one triangle; a ray that meets the edge exactly crosses one of them.
TEST(Triangle, AnEdgeIsCrossedOnce) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const auto pick = [&] { return float(int(random.below(9)) - 4); };
    const Vec3 a{pick(), pick(), 0}, b{pick(), pick(), 0};
    if (a == b) continue;
    const Vec3 side{b.y - a.y, a.x - b.x, 0};
    const Vec3 left = a + side, right = b - side, middle = (a + b) * 0.5f;
    for (const float z : {1.0f, -1.0f}) {
      const Vec3 from{middle.x, middle.y, 3 * z};
      const int count = crosses({a, b, left}, from, {0, 0, -z}) + crosses({b, a, right}, from, {0, 0, -z});
      EXPECT_EQ(count, 1);
      // The winding and the order of the vertices make no difference.
      EXPECT_EQ(crosses({a, b, left}, from, {0, 0, -z}), crosses({left, b, a}, from, {0, 0, -z}));
      EXPECT_EQ(crosses({a, b, left}, from, {0, 0, -z}), crosses({b, left, a}, from, {0, 0, -z}));
    }
  }
}

// Floats put these points on the edge; only the exact sign tells the two sides apart.
TEST(Triangle, SignsAreExact) {
  const float one = 1, more = std::nextafter(1.0f, 2.0f), still_more = std::nextafter(more, 2.0f);
  EXPECT_EQ(more * more, one * still_more);                          // the float products are equal,
  EXPECT_EQ(detail::edge_sign({more, one}, {still_more, more}), 1);  // the true ones are not
  EXPECT_EQ(detail::edge_sign({still_more, more}, {more, one}), -1);
  EXPECT_EQ(detail::edge_sign({1e-30f, 0}, {0, 1e-30f}), 1);  // underflows in float
  EXPECT_EQ(detail::edge_sign({1e30f, 0}, {0, 1e30f}), 1);    // overflows in float
  EXPECT_EQ(detail::edge_sign({1, 1}, {1, 1}), 0);
}

TEST(Triangle, DegenerateOnesAreNeverHit) {
  Random random(3);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 a = random.in_box(splat(-1), splat(1)), b = random.in_box(splat(-1), splat(1));
    const Vec3 middle = (a + b) * 0.5f, d = random.direction();
    EXPECT_FALSE(crosses({a, a, a}, a - d, d));
    EXPECT_FALSE(crosses({a, b, b}, middle - d, d));
    EXPECT_FALSE(crosses({a, b, a}, a - d, d));
  }
  EXPECT_FALSE(crosses({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}, {1, 1, 5}, {0, 0, -1}));
  EXPECT_FALSE(crosses({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {-1, 0.25f, 0}, {1, 0, 0}));  // inside the plane
}

// From far along an axis an interpolated t of a large triangle is off by the rounding of its far vertices.
TEST(Triangle, TOfALargeTriangleIsThatOfItsPlane) {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const float height = random.uniform(-10, 10);
    const auto corner = [&](float x, float y) { return Vec3{x * 1e6f, y * 1e6f, height}; };
    Crossing crossing;
    const Vec3 from{random.uniform(-1, 1), random.uniform(-1, 1), 20};
    ASSERT_TRUE(
        intersect_triangle(line(from, {0, 0, -1}), corner(-1, -1), corner(2, -1), corner(-1, 2), crossing));
    EXPECT_FLOAT_EQ(crossing.t, 20 - height);
  }
}

TEST(Triangle, NearestPointOfDegenerateTriangles) {
  const Triangle two_coincide{{0, 0, 0}, {0, 0, 0}, {2, 0, 0}};
  EXPECT_EQ(two_coincide.closest_point({1, 1, 0}), (Vec3{1, 0, 0}));
  const Triangle on_a_line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_EQ(on_a_line.closest_point({1.5f, 1, 0}), (Vec3{1.5f, 0, 0}));
  const Triangle point{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  EXPECT_EQ(point.closest_point({7, 7, 7}), (Vec3{1, 2, 3}));
}

TEST(Triangle, NearestPointBeatsEverySample) {
  Random random(5);
  for (float scale : {1e-30f, 1.0f, 1e30f})
    for (int i = 0; i < 300; ++i) {
      const auto pick = [&] { return random.in_box(splat(-1), splat(1)) * scale; };
      Triangle t{pick(), pick(), pick()};
      if (i % 3 == 0) t.c = t.a + (t.b - t.a) * 1.5f + pick() * 1e-4f;  // a needle
      const Vec3 p = pick() * 2.0f;
      const auto far = [&](Vec3 q) {
        return std::hypot(double(q.x) - p.x, double(q.y) - p.y, double(q.z) - p.z);
      };
      const double nearest = far(t.closest_point(p));
      for (int u = 0; u <= 40; ++u)
        for (int v = 0; u + v <= 40; ++v)
          ASSERT_LE(nearest,
                    far(t.a + (t.b - t.a) * (float(u) / 40) + (t.c - t.a) * (float(v) / 40)) + 1e-6 * scale);
    }
}

TEST(Triangle, TouchingABoxIsOverlap) {
  const Box3 box{{0, 0, 0}, {1, 1, 1}};
  EXPECT_TRUE((Triangle{{1, 1, 1}, {2, 1, 1}, {1, 2, 1}}.overlaps(box)));              // by a corner
  EXPECT_TRUE((Triangle{{-5, -5, 0.5f}, {5, -5, 0.5f}, {0, 9, 0.5f}}.overlaps(box)));  // cuts right through
  EXPECT_TRUE((Triangle{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}.overlaps(box)));  // touches (1, 1, 1) with its face
  EXPECT_FALSE((Triangle{{3.01f, 0, 0}, {0, 3.01f, 0}, {0, 0, 3.01f}}.overlaps(box)));
  EXPECT_FALSE((Triangle{{2.1f, 0, 0}, {0, 2.1f, 0}, {2.1f, 2.1f, 0}}.overlaps(box)));  // only its box does
  EXPECT_FALSE((Triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}.overlaps(Box3{})));
}

TEST(Triangle, PartsInRegionsCoverIt) {
  // Cut space into two by a plane, again and again: each point of the triangle is in the box of a part.
  Random random(31);
  for (int i = 0; i < 3000; ++i) {
    const float size = std::ldexp(1.0f, int(random.below(40)) - 20);
    const Vec3 shift = i % 3 == 0 ? random.in_box(splat(-1000), splat(1000)) : Vec3{};
    const auto corner = [&] { return shift + random.in_box(splat(-1), splat(1)) * size; };
    Triangle t{corner(), corner(), corner()};
    if (i % 5 == 0) t.b.z = t.c.z = t.a.z;
    if (i % 7 == 0) t.c = t.a;
    std::vector<Box3> regions{t.box()};
    for (int cut = 0; cut < 5; ++cut) {
      const Box3 region = regions[random.below(std::uint32_t(regions.size()))];
      const int axis = int(random.below(3));
      Box3 below = region, above = region;
      below.upper[axis] = above.lower[axis] =
          region.lower[axis] + (region.upper[axis] - region.lower[axis]) * random.uniform();
      std::erase(regions, region);
      regions.push_back(below);
      regions.push_back(above);
    }
    std::vector<Box3> parts;
    for (const Box3& region : regions) {
      parts.push_back(t.clipped_box(region));
      EXPECT_TRUE(region.contains(parts.back()) && t.box().contains(parts.back()));
    }
    for (const Vec3 vertex : {t.a, t.b, t.c})
      EXPECT_TRUE(std::any_of(parts.begin(), parts.end(), [&](const Box3& p) { return p.contains(vertex); }));
    for (int k = 0; k < 30; ++k) {
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      if (k % 3 == 0) v = 0;
      const auto at = [&](int axis) {
        return t.a[axis] + u * (double(t.b[axis]) - t.a[axis]) + v * (double(t.c[axis]) - t.a[axis]);
      };
      EXPECT_TRUE(std::any_of(parts.begin(), parts.end(), [&](const Box3& p) {
        // What is looked for is rounded itself.
        const double slack = 1e-14 * (1000 + size);
        for (int axis = 0; axis < 3; ++axis)
          if (!(p.lower[axis] <= at(axis) + slack && at(axis) - slack <= p.upper[axis])) return false;
        return true;
      }));
    }
  }
}

TEST(Triangle, PartsAreTight) {
  const Triangle t{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
  const Box3 part = t.clipped_box({{0.5f, -1, -1}, {2, 2, 2}});
  EXPECT_EQ(part.lower.x, 0.5f);
  EXPECT_EQ(part.upper.x, 1);
  EXPECT_EQ(part.lower.y, 0);
  EXPECT_NEAR(part.upper.y, 0.5f, 1e-6f);
  EXPECT_NEAR(part.upper.z, 0.5f, 1e-6f);
  EXPECT_TRUE(t.clipped_box({{0.6f, 0.6f, 0}, {2, 2, 2}}).is_empty());
  EXPECT_TRUE(t.clipped_box(Box3{}).is_empty());
  EXPECT_EQ(t.clipped_box({splat(-5), splat(5)}), t.box());
}

}  // namespace
}  // namespace boxwood
