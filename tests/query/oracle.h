// oracle.h: does every tree give the answer of brute force?
//
// One call checks one set of shapes: it makes rays, points and regions that are hard for exactly these
// shapes, asks brute force, and then asks every builder's tree, at several leaf sizes, and a few random
// trees. Answers must be equal.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/core/random.h"
#include "boxwood/query/all_hits.h"
#include "boxwood/query/any_hit.h"
#include "boxwood/query/closest_hit.h"
#include "boxwood/query/closest_point.h"
#include "boxwood/query/nearest.h"
#include "boxwood/query/overlap.h"
#include "boxwood/reference/brute_force.h"
#include "support/random_tree.h"

namespace boxwood::test {

struct NamedTree {
  std::string name;
  Bvh bvh;
};

/// Trees of every method at several leaf sizes, and random ones.
inline std::vector<NamedTree> every_tree(const std::vector<Box3>& boxes) {
  std::vector<NamedTree> trees;
  for (const auto& [method, name] :
       {std::pair{Method::longest_axis, "longest_axis"}, std::pair{Method::binned_sah, "binned_sah"},
        std::pair{Method::sweep_sah, "sweep_sah"}, std::pair{Method::ploc, "ploc"}})
    for (int leaf_size : {1, 4, 13}) {
      BuildOptions options;
      options.method = method;
      options.leaf_size = leaf_size;
      trees.push_back(
          {std::string(name) + ", leaf size " + std::to_string(leaf_size), build(boxes, options)});
    }
  for (std::uint64_t seed : {1, 2, 3}) trees.push_back({"random tree", random_tree(boxes, 3, seed)});
  return trees;
}

/// Points that matter to the shapes: corners and middles of their boxes, and whatever the caller adds.
template <class Shape>
std::vector<Vec3> targets_of(const std::vector<Shape>& shapes, std::vector<Vec3> targets, Random& random) {
  for (const Shape& shape : shapes) {
    const Box3 box = shape.box();
    if (box.is_empty()) continue;
    targets.push_back(box.corner(static_cast<int>(random.below(8))));
    targets.push_back(box.center());
  }
  if (targets.empty()) targets.push_back({0, 0, 0});
  return targets;
}

/// Rays that are hard for shapes with these targets inside `bounds`.
inline std::vector<Ray> hard_rays(const std::vector<Vec3>& targets, const Box3& bounds, int count,
                                  Random& random) {
  const Vec3 middle = bounds.is_empty() ? Vec3{} : bounds.center();
  float size = bounds.is_empty() ? 1.0f : max_component(bounds.extent());
  if (!(size > 0)) size = 1;
  const auto target = [&] { return targets[random.below(static_cast<std::uint32_t>(targets.size()))]; };
  const auto around = [&] { return middle + random.in_box(splat(-1), splat(1)) * size; };
  const auto axis = [&] {
    Vec3 d{0, 0, 0};
    d[static_cast<int>(random.below(3))] = random.below(2) ? 1.0f : -1.0f;
    return d;
  };

  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3 a = target(), b = target(), from = around();
    Vec3 in_plane = b - a;
    in_plane[static_cast<int>(random.below(3))] = random.below(2) ? 0.0f : -0.0f;
    rays.push_back({from, 0, random.direction(), kInfinity});  // anywhere
    rays.push_back({from, 0, a - from, kInfinity});            // at a corner or a middle
    rays.push_back({from, 0, (a * 0.5f + b * 0.5f) - from, kInfinity});
    const Vec3 d = axis();
    rays.push_back({a - d * size * 2.0f, 0, d, kInfinity});  // along an axis, exactly through
    rays.push_back({a - in_plane, 0, in_plane, kInfinity});  // inside a face's plane
    rays.push_back({a - (b - a), 0, b - a, kInfinity});      // along an edge
    rays.push_back({a, 0, random.direction(), kInfinity});   // from a surface or a corner
    rays.push_back({a, 0, axis(), kInfinity});
    rays.push_back({from, 0, (a - from) * 1e-20f, kInfinity});  // t runs to 1e20
    rays.push_back({from, random.uniform(0, 1), a - from, random.uniform(0, 2)});
  }
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity}) {
    rays.push_back({{0, bad, 0}, 0, {0, 0, 1}, kInfinity});
    rays.push_back({{0, 0, 0}, 0, {0, bad, 1}, kInfinity});
  }
  rays.push_back({middle, 0, {0, 0, 0}, kInfinity});
  rays.push_back({middle, 0, {-0.0f, 0, -1e-40f}, kInfinity});
  rays.push_back({middle, std::numeric_limits<float>::quiet_NaN(), {0, 0, 1}, kInfinity});
  rays.push_back({middle, 0, {0, 0, 1}, std::numeric_limits<float>::quiet_NaN()});
  rays.push_back({middle, -5, {0, 0, 1}, kInfinity});
  rays.push_back({middle, 2, {0, 0, 1}, 1});
  return rays;
}

/// Adds rays whose limits lie on, just before and just behind something that they hit.
template <class Shape>
void add_limited_rays(std::vector<Ray>& rays, const reference::BruteForce<Shape>& brute, Random& random) {
  std::vector<ShapeHit> hits;
  const std::size_t count = rays.size();
  for (std::size_t i = 0; i < count; i += 3) {
    Ray ray = rays[i];
    brute.all_hits(ray, hits);
    if (hits.empty()) continue;
    const float t = hits[random.below(static_cast<std::uint32_t>(hits.size()))].t;
    switch (random.below(5)) {
      case 0:
        ray.t_max = t;
        break;
      case 1:
        ray.t_min = t;
        break;
      case 2:
        ray.t_min = ray.t_max = t;
        break;
      case 3:
        ray.t_max = std::nextafter(t, -1.0f);
        break;
      case 4:
        ray.t_min = std::nextafter(t, kInfinity);
        break;
    }
    rays.push_back(ray);
  }
}

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
