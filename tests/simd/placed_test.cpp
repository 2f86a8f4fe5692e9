// placed_test.cpp: do the kernels answer below a placement as brute force does with its two gates?
//
// Each crossing passes the gate of its triangle's box in object space, with a t_min that may be negative or
// -inf, and then that of the placement (shape/gate.h). The placement's interval is narrow here, so that many
// crossings are moved or dropped.
#include <algorithm>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/core/random.h"
#include "boxwood/shape/gate.h"
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
        const PreparedRay ray(world_space.origin + (a - b) * (random.below(4) ? 0.0f : 0.25f),
                              world_space.direction, inner_t_min(world, inside), world.t_max, bounds);
        const Crossings expected = brute_crossings(triangles, world, ray, inside, world.t_max);

        TriangleHit hit;
        bool is_hit = false;
        std::vector<TriangleHit> all;
        const Passage passage{inside, world.t_min};
        const Ray local{ray.origin, ray.t_min, ray.direction, ray.t_max};
        const bool is_answered = kernels->placed_closest_hit(*tree, local, bounds, passage, world.t_max, hit);
        if (kernels->placed_any_hit(*tree, local, bounds, passage, world.t_max, is_hit) != is_answered ||
            kernels->placed_all_hits(*tree, local, bounds, passage, world.t_max, all) != is_answered)
          ++wrong;
        if (!is_answered) continue;
        Crossings found;
        for (const TriangleHit& one : all) found.push_back({one.t, one.key});
        std::sort(found.begin(), found.end());
        wrong += found != expected;
        wrong += is_hit == expected.empty() || hit.is_hit() == expected.empty();
        if (!expected.empty() && hit.is_hit())
          wrong += !test::same_bits(hit.t, expected.front().first) || hit.key != expected.front().second;

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
