// ray_order_test.cpp: is a large batch that is sorted first answered as any other?
#include "boxwood/scene/ray_order.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/gallery/gallery.h"
#include "boxwood/scene/parts.h"

namespace boxwood {
namespace {

constexpr Box3 kCube{{0, 0, 0}, {1, 1, 1}};

std::vector<Ray> scattered_rays(const Box3& bounds, std::size_t count, float t_max = kInfinity) {
  Random random(12);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i)
    rays.push_back({random.in_box(bounds.lower, bounds.upper), 0, random.direction(), t_max});
  return rays;
}

TEST(RayOrder, NamesEachRayOnceAndNeighboursTogether) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  std::vector<Ray> rays = scattered_rays(kCube, 5000);
  rays[7].origin.x = kNan;
  rays[8].origin = {kInfinity, -kInfinity, 1e30f};
  rays[9].direction = {kNan, 0, -0.0f};
  std::vector<std::uint64_t> order(rays.size());
  const std::unique_ptr<Executor> executor = make_executor(3);
  detail::find_ray_order(rays, kCube, order, *executor);

  std::set<std::uint32_t> seen;
  std::size_t turns = 0;
  double way = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto ray = static_cast<std::uint32_t>(order[i]);
    EXPECT_TRUE(ray < rays.size() && seen.insert(ray).second) << ray;
    const auto before = static_cast<std::uint32_t>(order[i == 0 ? 0 : i - 1]);
    if (std::min(ray, before) < 10) continue;  // odd ones may be among these
    for (int k = 0; k < 3; ++k) turns += (rays[ray].direction[k] < 0) != (rays[before].direction[k] < 0);
    way += length(rays[ray].origin - rays[before].origin);
  }
  EXPECT_EQ(seen.size(), rays.size());
  EXPECT_LE(turns, 30u);                      // seven changes of the octant, of up to three signs each
  EXPECT_LT(way / double(rays.size()), 0.2);  // in any order 0.66
}

TEST(RayOrder, KnowsWhatIsScattered) {
  EXPECT_TRUE(detail::are_scattered(scattered_rays(kCube, 70'000), kCube));
  EXPECT_FALSE(detail::are_scattered(scattered_rays(kCube, 100), kCube));
  EXPECT_FALSE(detail::are_scattered({}, kCube));
  // From one eye, and from the points along the lines of a picture.
  std::vector<Ray> rays = scattered_rays(kCube, 70'000);
  for (Ray& ray : rays) ray.origin = {0.5f, 0.5f, 2};
  EXPECT_FALSE(detail::are_scattered(rays, kCube));
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays[i].origin = {float(i % 256) / 256, 0.5f, float(i) / 7e4f};
  EXPECT_FALSE(detail::are_scattered(rays, kCube));
}

/// Compares batches with single rays. Some of the rays are odd in some way or other.
void expect_same_as_single(const Scene& scene, std::vector<Ray> rays) {
  for (std::size_t i = 0; i < rays.size(); i += 1000) rays[i].direction.y = 0;
  for (std::size_t i = 1; i < rays.size(); i += 1000) rays[i].origin.z = 1e30f;
  for (std::size_t i = 2; i < rays.size(); i += 1000) rays[i].t_max = -1;
  std::vector<Hit> hits(rays.size());
  const std::unique_ptr<bool[]> is_hit(new bool[rays.size()]);
  std::size_t wrong = 0, found = 0;
  for (const int threads : {1, 3}) {
    const std::unique_ptr<Executor> executor = make_executor(threads);
    std::fill(hits.begin(), hits.end(), Hit{});
    scene.closest_hit(rays, hits, executor.get());
    scene.any_hit(rays, std::span(is_hit.get(), rays.size()), executor.get());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit expected = scene.closest_hit(rays[i]);
      wrong += hits[i] != expected || is_hit[i] != expected.is_hit();
      found += expected.is_hit();
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(found, 0u);
}

TEST(RayOrder, SortedBatchesGiveTheAnswersOfSingleRays) {
  // A soup that outgrows the caches, of which each ray visits much.
  const Scene scene(gallery::make("soup:500000"), BuildOptions::fast());
  ASSERT_TRUE(scene.parts().world.may_sort_rays);
  if (!scene.parts().kernels) return;  // plain C++ is slow enough not to wait for memory
  expect_same_as_single(scene, scattered_rays(scene.bounds(), detail::kLeastSorted + 123, 0.2f));

  // More than are sorted at once, and a rest that is not sorted: rays that end soon.
  const float end = 0.001f * length(scene.bounds().extent());
  expect_same_as_single(scene, scattered_rays(scene.bounds(), detail::kMostSorted + 500, end));
}

TEST(RayOrder, SmoothAndSmallScenesAreNotSorted) {
  EXPECT_FALSE(Scene(gallery::make("soup:20000")).parts().world.may_sort_rays);
  EXPECT_FALSE(Scene(gallery::make("terrain:512"), BuildOptions::fast()).parts().world.may_sort_rays);
}

}  // namespace
}  // namespace boxwood
