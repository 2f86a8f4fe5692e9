// oracle.h: does every tree give the answer of brute force?
//
// One call checks one set of shapes: it makes rays, points and regions that are hard for exactly these
// shapes, asks brute force, and then asks every builder's tree, at several leaf sizes, and a few random
// trees. Answers must be equal.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "boxwood/query/all_hits.h"
#include "boxwood/query/any_hit.h"
#include "boxwood/query/closest_hit.h"
#include "boxwood/query/closest_point.h"
#include "boxwood/query/nearest.h"
#include "boxwood/query/overlap.h"
#include "boxwood/reference/brute_force.h"
#include "support/every_tree.h"
#include "support/hard_rays.h"

namespace boxwood::test {

/// Checks every query on every tree. `extra_targets`: vertices and the like. `scale` of the work: 1 is about
/// 20 rays of each kind.
template <class Shape>
void expect_equal_to_brute_force(const std::string& name, const std::vector<Shape>& shapes,
                                 const std::vector<Vec3>& extra_targets = {}, int scale = 1) {
  SCOPED_TRACE(name);
  Random random(7, std::hash<std::string>{}(name));
  const reference::BruteForce brute(shapes);
  const std::vector<Box3> all_boxes = boxes(shapes);
  const std::vector<NamedTree> trees = every_tree(all_boxes);
  const std::vector<Vec3> targets = targets_of(shapes, extra_targets, random);

  // Rays.
  std::vector<Ray> rays = hard_rays(targets, brute.bounds(), 60 * scale, random);
  add_limited_rays(rays, brute, random);
  std::size_t hit_count = 0, disagreements = 0;
  std::vector<ShapeHit> expected, found;
  const auto disagree = [&](const std::string& tree, const char* query) {
    if (++disagreements <= 3) ADD_FAILURE() << query << " on " << tree << " differs from brute force";
  };
  for (const Ray& ray : rays) {
    const ShapeHit first = brute.closest_hit(ray);
    brute.all_hits(ray, expected);
    ASSERT_EQ(first, expected.empty() ? ShapeHit{} : expected.front());
    ASSERT_EQ(first.is_hit(), brute.any_hit(ray));
    hit_count += expected.size();
    for (const NamedTree& tree : trees) {
      if (!(closest_hit(tree.bvh, shapes, ray) == first)) disagree(tree.name, "closest_hit");
      if (any_hit(tree.bvh, shapes, ray) != first.is_hit()) disagree(tree.name, "any_hit");
      all_hits(tree.bvh, shapes, ray, found);
      if (found != expected) disagree(tree.name, "all_hits");
    }
  }
  EXPECT_TRUE(hit_count > 0 || brute.bounds().is_empty()) << "the rays are too easy: nothing was hit";

  // Points, near and far, on shapes and off.
  const Vec3 extent = brute.bounds().is_empty() ? splat(1) : brute.bounds().extent();
  const auto region_size = [&] { return extent * (random.uniform() * random.uniform()); };
  for (int i = 0; i < 60 * scale; ++i) {
    const Vec3 target = targets[random.below(static_cast<std::uint32_t>(targets.size()))];
    const Vec3 off = random.in_box(splat(-1), splat(1)) * extent;
    const Vec3 point = i % 4 == 0   ? target
                       : i % 4 == 1 ? target + off * 1e-3f
                       : i % 4 == 2 ? off
                                    : off * 1e3f;
    const float reach = i % 3 == 0 ? max_component(extent) * random.uniform() : kInfinity;
    const Box3 region = i % 3 == 0 ? Box3{target, target} : Box3{target, target + region_size()};

    if constexpr (HasClosestPoint<Shape>) {
      const ShapePoint nearest_one = brute.closest_point(point, reach);
      const std::vector<ShapePoint> nearest_ones = brute.nearest(point, 1 + i % 9, reach);
      const std::vector<PrimId> in_ball = brute.overlap(point, reach);
      // A ball that ends exactly at a shape still touches it.
      const std::vector<PrimId> touching = brute.overlap(point, nearest_one.distance);
      for (const NamedTree& tree : trees) {
        if (!(closest_point(tree.bvh, shapes, point, reach) == nearest_one))
          disagree(tree.name, "closest_point");
        if (nearest(tree.bvh, shapes, point, 1 + i % 9, reach) != nearest_ones)
          disagree(tree.name, "nearest");
        if (overlap(tree.bvh, shapes, point, reach) != in_ball) disagree(tree.name, "overlap with a ball");
        if (overlap(tree.bvh, shapes, point, nearest_one.distance) != touching)
          disagree(tree.name, "overlap with a touching ball");
      }
      EXPECT_TRUE(!nearest_one.is_found() || !touching.empty());
    }
    if constexpr (HasOverlap<Shape>) {
      const std::vector<PrimId> in_box = brute.overlap(region);
      for (const NamedTree& tree : trees)
        if (overlap(tree.bvh, shapes, region) != in_box) disagree(tree.name, "overlap with a box");
    }
  }
  EXPECT_EQ(disagreements, 0u);
}

}  // namespace boxwood::test
