// scene_checks.h: do all ways to ask a scene agree, with each other and with a search without trees?
#pragma once

#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "scene/scene_oracle.h"

namespace boxwood::test {

/// Rays through `bounds` from inside and outside, with all kinds of odd ones among them.
inline std::vector<Ray> mixed_rays(const Box3& bounds, std::size_t count, std::uint64_t seed) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  Random random(seed);
  const float size = length(bounds.extent());
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    Ray& ray = rays[i];
    const Vec3 inside = random.in_box(bounds.lower, bounds.upper);
    ray.origin = i % 2 ? inside : bounds.center() + random.direction() * size;
    ray.direction = i % 2 ? random.direction() : inside - ray.origin;
    const int axis = static_cast<int>(random.below(3));
    switch (random.below(40)) {
      case 0:
        ray.origin[axis] = kNan;
        break;
      case 1:
        ray.direction[axis] = kNan;
        break;
      case 2:
        ray.t_min = kNan;
        break;
      case 3:
        ray.t_max = kNan;
        break;
      case 4:
        ray.origin[axis] = random.below(2) ? kInfinity : -kInfinity;
        break;
      case 5:
        ray.direction[axis] = kInfinity;
        break;
      case 6:
        ray.direction = {0, random.below(2) ? 0.0f : -0.0f, 0};
        break;
      case 7:
        std::swap(ray.t_min, ray.t_max);
        break;
      case 8:  // from very far: hits at a huge t, through floats that overflow in a kernel
        ray.direction = normalize(inside - ray.origin);
        ray.origin = inside - ray.direction * 0x1p60f;
        break;
      case 9:
        ray.direction = ray.direction * 0x1p-60f;
        break;
      case 10:
        ray.direction = ray.direction * 0x1p60f;
        break;
      case 11:
        ray.direction = ray.direction * 0x1p-140f;
        break;
      case 12:
        ray.origin = ray.origin * 0x1p-140f;
        break;
      case 13:
        ray.direction[axis] = 0;
        break;
      case 14:
        ray.direction = {0, 0, 0};
        ray.direction[axis] = -1;
        break;
      case 15:
        ray.t_min = -1;
        break;
      case 16:
        ray.t_max = size * random.uniform();
        break;
      case 17:
        ray.t_max = 0;
        break;
      case 18:
        ray.direction[axis] = ray.direction[axis] * 0x1p-40f;
        break;
      default:
        break;
    }
  }
  return rays;
}

/// Single rays against a search without trees, where `expect_oracle`; batches of many sizes, lists and counts
/// against single rays. Returns how many rays hit.
inline std::size_t check_all(const Scene& scene, const std::vector<Ray>& rays, bool expect_oracle) {
  std::vector<Hit> single(rays.size()), all, all_of_each;
  std::vector<std::size_t> begin_of_each = {0};
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    single[i] = scene.closest_hit(rays[i]);
    hits += single[i].is_hit();
    EXPECT_EQ(scene.any_hit(rays[i]), single[i].is_hit()) << "ray " << i;
    scene.all_hits(rays[i], all);
    EXPECT_EQ(scene.count_hits(rays[i]), all.size()) << "ray " << i;
    EXPECT_EQ(all.empty() ? Hit{} : all[0], single[i]) << "ray " << i;
    all_of_each.insert(all_of_each.end(), all.begin(), all.end());
    begin_of_each.push_back(all_of_each.size());
    TraversalStatistics statistics;
    EXPECT_EQ(scene.closest_hit(rays[i], statistics), single[i]) << "ray " << i;
    if (expect_oracle) {
      const std::vector<Hit> expected = all_hits_without_trees(scene, rays[i]);
      EXPECT_EQ(all.size(), expected.size()) << "ray " << i;
      for (std::size_t k = 0; k < std::min(all.size(), expected.size()); ++k) {
        all[k].normal = {};
        EXPECT_EQ(all[k], expected[k]) << "ray " << i;
      }
    }
    if (testing::Test::HasFailure()) return hits;
  }

  const auto two = make_executor(2);
  for (Executor* executor : {&serial_executor(), two.get()}) {
    std::vector<std::size_t> begins = {9}, counts(rays.size());
    scene.all_hits(rays, begins, all, executor);
    scene.count_hits(rays, counts, executor);
    EXPECT_EQ(begins, begin_of_each);
    EXPECT_EQ(all, all_of_each);
    for (std::size_t i = 0; i < rays.size(); ++i)
      EXPECT_EQ(counts[i], begin_of_each[i + 1] - begin_of_each[i]) << "ray " << i;
    if (testing::Test::HasFailure()) return hits;
  }

  std::vector<Hit> batch(rays.size());
  const std::unique_ptr<bool[]> is_hit(new bool[rays.size()]);
  for (const std::size_t size :
       {std::size_t(1), std::size_t(7), std::size_t(33), std::size_t(700), rays.size()})
    for (Executor* executor : {&serial_executor(), two.get()}) {
      batch.assign(rays.size(), Hit{});
      for (std::size_t begin = 0; begin < rays.size(); begin += size) {
        const std::size_t count = std::min(size, rays.size() - begin);
        scene.closest_hit(std::span(rays).subspan(begin, count), std::span(batch).subspan(begin, count),
                          executor);
        scene.any_hit(std::span(rays).subspan(begin, count), std::span(&is_hit[begin], count), executor);
      }
      for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(batch[i], single[i]) << "ray " << i << " in batches of " << size;
        EXPECT_EQ(is_hit[i], single[i].is_hit()) << "ray " << i << " in batches of " << size;
        if (testing::Test::HasFailure()) return hits;
      }
    }
  return hits;
}

}  // namespace boxwood::test
