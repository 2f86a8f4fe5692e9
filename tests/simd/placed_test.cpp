// placed_test.cpp: do the kernels answer below a placement as brute force does with its two gates?
//
// Each crossing passes the gate of its triangle's box in object space, with a t_min that may be negative or
// -inf, and then that of the placement (shape/gate.h). The placement's interval is narrow here, so that many
// crossings are moved or dropped. Asked of the kernels for one placement, and of those that go there by
// themselves.
#include <algorithm>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/core/random.h"
#include "boxwood/shape/gate.h"
#include "boxwood/tree/collapse.h"
#include "kernel_oracle.h"
#include "support/hard_rays.h"
#include "support/meshes.h"
#include "support/shapes.h"

namespace boxwood::simd {
namespace {

using Crossings = std::vector<std::pair<float, std::uint32_t>>;

struct Sink {
  float t_max;
  std::uint32_t key;
  Crossings& crossings;
  float limit() const { return t_max; }
  void report(const Crossing& crossing) { crossings.push_back({crossing.t, key}); }
};

Crossings brute_crossings(const std::vector<Triangle>& triangles, const PreparedRay& world,
                          const PreparedRay& ray, const Interval& inside, float t_max) {
  Crossings crossings;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    Sink sink{t_max, i, crossings};
    BoxGate<Sink> gate(world, inside, sink);
    intersect_gated(ray, triangles[i], gate);
  }
  std::sort(crossings.begin(), crossings.end());
  return crossings;
}

PlacedTrees place(int width, const TriangleTree& tree, const Affine3& object_from_world,
                  const Box3& world_box, const Box3& bounds) {
  const Box3 boxes[] = {world_box};
  const Bvh bvh = build(boxes);
  return {with_width(width, [&](auto w) { return BoxTree(collapse<w()>(bvh, serial_executor()), boxes); }),
          {{object_from_world, world_box, bounds, &tree, tree.pool(), tree.box_slack(), 5, 0}}};
}

/// Counts what the kernels that go below placements by themselves answer wrong: one ray, and as a batch.
std::size_t count_wrong_below(const Kernels& kernels, const PlacedTrees& trees, const Ray& ray,
                              const Box3& bounds, const Crossings& expected) {
  const PlacedHit before{{ray.t_max + 0.0f}};
  PlacedHit one = before, batch = before;
  Hit full, batch_full;
  bool is_hit = false, is_batch_hit = false;
  std::vector<std::uint32_t> unusual;
  const std::uint32_t first = 0;
  const std::span<const std::uint32_t> order(&first, 1);
  const std::span<const Ray> rays(&ray, 1);
  if (!kernels.closest_hit_below(trees, ray, bounds, one, full)) return 1;
  if (!kernels.any_hit_below(trees, ray, bounds, is_hit)) return 1;
  kernels.closest_hits_below(trees, rays, bounds, order, &batch, nullptr, unusual);
  kernels.any_hits_below(trees, rays, bounds, order, &is_batch_hit, unusual);
  kernels.finish_hits_below(trees, rays, &batch, &batch_full);
  std::size_t wrong = unusual.size() + (is_hit == expected.empty()) + (is_batch_hit == expected.empty());
  wrong += one.is_placed() == expected.empty() || batch.is_placed() == expected.empty();
  wrong += full != batch_full;
  if (expected.empty() || wrong > 0) return wrong;

  const auto& [t, key] = expected.front();
  for (const PlacedHit& hit : {one, batch})
    wrong += !test::same_bits(hit.t, t) || hit.key != key || hit.item != 0 || hit.instance != 5;
  const PlacedTree& placed = trees.items()[0];
  const Triangle triangle = placed.tree->triangle(one.block, one.lane);
  Crossing crossing;
  intersect_triangle(
      RayShear(placed.object_from_world.point(ray.origin), placed.object_from_world.vector(ray.direction)),
      triangle.a, triangle.b, triangle.c, crossing);
  wrong += !test::same_bits(full.t, t) || !test::same_bits(full.u, crossing.u) ||
           !test::same_bits(full.v, crossing.v) || !test::same_bits(batch_full.u, crossing.u) ||
           !test::same_bits(batch_full.v, crossing.v) ||
           full.normal != normalize(transform_normal(placed.object_from_world, triangle.normal()));
  // What is as near already stays when its instance comes first, and not when it comes later.
  for (const std::uint32_t instance : {4u, 6u}) {
    PlacedHit other = before;
    other.t = t;
    other.instance = instance;
    Hit unused;
    kernels.closest_hit_below(trees, ray, bounds, other, unused);
    wrong += other.is_placed() != (instance == 6);
  }
  return wrong;
}

void expect_placed_right(const std::string& name, const std::vector<Triangle>& triangles) {
  SCOPED_TRACE(name);
  const Bvh bvh = build(boxes(triangles));
  const Box3 bounds = bvh.bounds();
  Random random(12, triangles.size());
  std::vector<Ray> rays =
      boxwood::test::hard_rays(boxwood::test::targets_of(triangles, {}, random), bounds, 200, random);
  boxwood::test::add_limited_rays(rays, reference::BruteForce(triangles), random);

  std::size_t asked = 0, hit_count = 0, at_ends = 0, behind = 0;
  for (const Kernels* kernels : available_kernels())
    for (const Layout layout : test::kLayouts) {
      const auto tree = test::pack(kernels->width, bvh, triangles, {}, layout);
      std::size_t wrong = 0;
      for (const Ray& world_space : rays) {
        // The world's box cuts through the mesh; or lies beyond its near side, so that all is moved forward.
        const Vec3 a = random.in_box(bounds.lower, bounds.upper),
                   b = random.in_box(bounds.lower, bounds.upper);
        const Box3 world_box = random.below(3) ? Box3{min(a, b), max(a, b)} : bounds;
        const PreparedRay world(world_space, bounds);
        if (!world.is_valid()) continue;
        const Interval inside = world.interval(world_box);
        if (inside.is_empty()) continue;
        const Affine3 map = Affine3::translation((a - b) * (random.below(4) ? 0.0f : 0.25f));
        const PreparedRay ray(map.point(world_space.origin), map.vector(world_space.direction),
                              inner_t_min(world, inside), world.t_max, bounds);
        const Crossings expected = brute_crossings(triangles, world, ray, inside, world.t_max);

        std::vector<TriangleHit> all;
        const Passage passage{inside, world.t_min};
        const Ray local{ray.origin, ray.t_min, ray.direction, ray.t_max};
        if (!kernels->placed_all_hits(*tree, local, bounds, passage, world.t_max, all)) continue;
        Crossings found;
        for (const TriangleHit& one : all) found.push_back({one.t, one.key});
        std::sort(found.begin(), found.end());
        wrong += found != expected;
        wrong += count_wrong_below(*kernels, place(kernels->width, *tree, map, world_box, bounds),
                                   world_space, bounds, expected);
        ++asked;
        hit_count += !expected.empty();
        behind += ray.t_min < 0 && !expected.empty();
        for (const auto& [t, key] : expected) at_ends += t == inside.entry || t == inside.exit;
      }
      EXPECT_EQ(wrong, 0u) << kernels->name;
    }
  if (available_kernels().empty()) return;
  EXPECT_GT(hit_count, asked / 10);
  EXPECT_GT(at_ends, 50u) << "nothing was moved by the placement's gate: too easy";
  EXPECT_GT(behind, 50u) << "no t_min was negative: too easy";
}

TEST(KernelPlaced, EqualToBruteForceThroughBothGates) {
  expect_placed_right("soup", boxwood::test::triangles(boxwood::test::triangle_soup(300)));
  expect_placed_right("sponge", boxwood::test::triangles(boxwood::test::sponge(1)));
  expect_placed_right("lattice", boxwood::test::lattice_shapes<Triangle>(200, 2));
  expect_placed_right("rough sphere", boxwood::test::triangles(boxwood::test::rough_sphere(2)));
}

}  // namespace
}  // namespace boxwood::simd
