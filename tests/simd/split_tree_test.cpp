// split_tree_test.cpp: do trees over pieces of triangles lose nothing?
//
// In such a tree a leaf holds part of a triangle, but the crossing is that of the whole: its t must lie where
// the ray passes the box of the part that it crosses (shape/gate.h). The hardest rays see a large triangle
// edge-on: there t is ill-conditioned, and pieces are small against its error if nothing is done about it.
#include <cmath>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/core/random.h"
#include "boxwood/query/traverse_wide.h"
#include "boxwood/tree/collapse.h"
#include "boxwood/tree/validate.h"
#include "kernel_oracle.h"

namespace boxwood::simd {
namespace {

struct SplitTriangles {
  std::vector<Triangle> triangles;
  std::vector<Box3> pieces;
  std::vector<PrimId> owners;

  /// Cuts `box` of a triangle at random places into up to 2^levels pieces, none much larger than it must be.
  void add_pieces(std::uint32_t triangle, const Box3& box, int levels, Random& random) {
    const int axis = static_cast<int>(random.below(3));
    const float place = box.lower[axis] + (box.upper[axis] - box.lower[axis]) * random.uniform(0.2f, 0.8f);
    if (levels == 0 || !(box.lower[axis] < place && place < box.upper[axis])) {
      pieces.push_back(box);
      owners.push_back(PrimId(triangle));
      return;
    }
    Box3 below = box, above = box;
    below.upper[axis] = above.lower[axis] = place;
    for (const Box3& half : {below, above}) {
      const Box3 part = triangles[triangle].clipped_box(half);
      if (!part.is_empty()) add_pieces(triangle, part, levels - 1, random);
    }
  }

  /// Cuts a triangle by the three planes through `point`.
  void add_octants(std::uint32_t triangle, Vec3 point) {
    const Box3 whole = triangles[triangle].box();
    for (int octant = 0; octant < 8; ++octant) {
      Box3 region = whole;
      for (int k = 0; k < 3; ++k) (octant >> k & 1 ? region.lower : region.upper)[k] = point[k];
      const Box3 part = triangles[triangle].clipped_box(intersect(region, whole));
      if (part.is_empty()) continue;
      pieces.push_back(part);
      owners.push_back(PrimId(triangle));
    }
  }

  /// Every piece in a leaf of its own.
  template <int W>
  WideBvh<W> tree() const {
    Bvh bvh = build(pieces, {.leaf_size = 1});
    for (PrimId& id : bvh.prim_ids) id = owners[id.value];
    WideBvh<W> wide = collapse<W>(bvh, serial_executor(), {.node = 0.001f, .block = 100});
    wide.has_parts = true;
    return wide;
  }
};

/// Large triangles: of any shape, needles, and flat along an axis or nearly so.
Triangle large_triangle(Random& random) {
  const auto point = [&] { return random.in_box(splat(-1), splat(1)); };
  Triangle t{point(), point(), point()};
  switch (random.below(4)) {
    case 0:
      t.c = t.a + (t.b - t.a) * random.uniform() + point() * 0.01f;
      break;
    case 1:
      for (Vec3* v : {&t.b, &t.c}) v->z = t.a.z;
      break;
    case 2:
      for (Vec3* v : {&t.b, &t.c}) v->z = t.a.z + random.uniform(-1e-4f, 1e-4f);
      break;
    default:
      break;
  }
  return t;
}

/// A ray through `through` that leaves the plane of `t` by an angle of 1e-8 to 1.
Ray edge_on_ray(const Triangle& t, Vec3 through, Random& random) {
  const float turn = random.uniform(0, 6.3f);
  const float lift = std::pow(10.0f, random.below(2) ? random.uniform(-8, 0) : random.uniform(-2, -0.5f));
  const Vec3 way = normalize((t.b - t.a) * std::cos(turn) + (t.c - t.a) * std::sin(turn)) + t.normal() * lift;
  return {through - way * random.uniform(0, 2), 0, way * random.uniform(0.5f, 2), kInfinity};
}

/// For whatever the rays cross, adds rays that begin, end, or both, just there.
void add_rays_that_end_there(const std::vector<Triangle>& triangles, std::vector<Ray>& rays) {
  const std::vector<test::Answer> answers = test::brute_answers(triangles, {}, rays);
  for (std::size_t i = 0; i < answers.size(); ++i)
    for (const auto& [t, key] : answers[i].crossings) {
      const Ray ray = rays[i];
      rays.push_back({ray.origin, t, ray.direction, t});
      rays.push_back({ray.origin, 0, ray.direction, t});
      rays.push_back({ray.origin, t, ray.direction, kInfinity});
    }
}

template <int W>
void expect_nothing_lost(const SplitTriangles& split, const std::vector<Ray>& rays,
                         const std::vector<test::Answer>& answers) {
  const WideBvh<W> wide = split.tree<W>();
  const std::vector<Box3> whole = boxes(split.triangles);
  ASSERT_EQ(validate(wide, whole), "");
  for (const Layout layout : test::kLayouts) {
    const TriangleTree tree(wide, split.triangles, {}, serial_executor(), layout);
    for (const Kernels* kernels : available_kernels())
      if (kernels->width == W) test::expect_equal_to(*kernels, tree, rays, wide.box, answers, true);
  }
}

void expect_nothing_lost(const SplitTriangles& split, std::vector<Ray> rays) {
  add_rays_that_end_there(split.triangles, rays);
  const std::vector<test::Answer> answers = test::brute_answers(split.triangles, {}, rays);
  expect_nothing_lost<4>(split, rays, answers);
  expect_nothing_lost<8>(split, rays, answers);
  expect_nothing_lost<16>(split, rays, answers);
}

TEST(KernelSplitTrees, LargeTrianglesSeenEdgeOn) {
  Random random(31);
  for (int round = 0; round < 30 && !testing::Test::HasFailure(); ++round) {
    SCOPED_TRACE(round);
    SplitTriangles split;
    for (std::uint32_t i = 0; i < 1u + static_cast<std::uint32_t>(round) % 3; ++i) {
      split.triangles.push_back(large_triangle(random));
      split.add_pieces(i, split.triangles[i].box(), 6, random);
    }
    std::vector<Ray> rays;
    for (int i = 0; i < 1000; ++i) {
      const Triangle& t = split.triangles[random.below(static_cast<std::uint32_t>(split.triangles.size()))];
      const float u = random.uniform(), v = random.uniform() * (1 - u);
      rays.push_back(edge_on_ray(t, t.a + (t.b - t.a) * u + (t.c - t.a) * v, random));
    }
    expect_nothing_lost(split, rays);
  }
}

/// The point of the triangle that the line passes, by exact weights.
Vec3 crossed_point(const Triangle& triangle, const PreparedRay& ray) {
  const int kx = ray.axis_x, ky = ray.axis_y, kz = ray.axis_z;
  const auto flat = [&](Vec3 v) {
    const Vec3 to = v - ray.origin;
    return detail::Point2{to[kx] - ray.shear_x * to[kz], to[ky] - ray.shear_y * to[kz]};
  };
  const detail::ExactWeights w(flat(triangle.a), flat(triangle.b), flat(triangle.c));
  Vec3 point;
  for (int k = 0; k < 3; ++k)
    point[k] =
        static_cast<float>((w.a * triangle.a[k] + w.b * triangle.b[k] + w.c * triangle.c[k]) / w.sum());
  return point;
}

/// How far `point` is from all pieces, in the max norm.
float distance_from(const std::vector<Box3>& pieces, Vec3 point) {
  float least = kInfinity;
  for (const Box3& box : pieces)
    least = min(least, max_component(max(max(box.lower - point, point - box.upper), splat(0))));
  return least;
}

/// Visits what the plain walk of a scene visits for boxes of parts.
struct PartVisitor {
  PreparedRay ray;
  float t;
  int leaves = 0;
  float bound(const Box3& box) const { return ray.bound(box); }
  float limit() const { return t; }
  void visit(ChildRef) { ++leaves; }
};

// Where an edge goes from one piece to the next their boxes meet in a corner. A ray may cross the triangle
// just before it, and its t, a little off, lie just behind, in neither box. Here are such rays, with the
// origin next to 0 and so with the least slack, for which half as much slack again would not do: one ray in a
// hundred thousand. The triangle is cut between where they cross it and where their t says so.
TEST(KernelSplitTrees, CutsBetweenACrossingAndItsT) {
  Random random(32);
  const auto point = [&random] { return random.in_box(splat(-1), splat(1)); };
  int found = 0;
  for (int i = 0; i < 4'000'000 && found < 6; ++i) {
    Triangle t{point(), point(), {}};
    t.c = t.a + (t.b - t.a) * random.uniform() + point();
    const Vec3 at_edge = t.a + (t.b - t.a) * random.uniform(0.2f, 0.8f), edge = normalize(t.b - t.a);
    const Vec3 through = at_edge + (t.c - at_edge) * std::pow(10.0f, random.uniform(-7, -5.5f));
    const Vec3 outwards = normalize(at_edge - t.c - edge * dot(at_edge - t.c, edge));
    const Vec3 way =
        outwards + edge * random.uniform(-1, 1) + t.normal() * std::pow(10.0f, random.uniform(-1.5f, -1.2f));
    const Vec3 from = through - way * random.uniform();
    t = {t.a - from, t.b - from, t.c - from};
    const Ray ray{point() * 1e-7f, 0, way, kInfinity};
    const PreparedRay prepared(ray, t.box());
    Crossing crossing;
    if (!intersect_triangle(prepared, t.a, t.b, t.c, crossing)) continue;
    const Vec3 crossed = crossed_point(t, prepared), reached = ray.origin + way * crossing.t;
    const float slack =
        12 * 0x1p-24f * max(max_component(abs(t.box().lower)), max_component(abs(t.box().upper)));
    if (max_component(abs(reached - crossed)) < 1.6f * slack) continue;
    SplitTriangles split;
    split.triangles = {t};
    split.add_octants(0, (crossed + reached) * 0.5f);
    if (distance_from(split.pieces, reached) < 1.6f * slack) continue;

    ++found;
    expect_nothing_lost(split, {ray});
    const WideBvh<8> wide = split.tree<8>();
    PartVisitor visitor{prepared.widened(kPartSlack), crossing.t};
    visitor.ray.t_min = crossing.t;
    NoStatistics none;
    traverse_wide<8>(
        [&](ChildRef node) -> const auto& { return wide.nodes[node.index()]; }, visitor, none);
    EXPECT_GT(visitor.leaves, 0);
  }
  EXPECT_EQ(found, 6) << "the rays are too easy";
}

}  // namespace
}  // namespace boxwood::simd
