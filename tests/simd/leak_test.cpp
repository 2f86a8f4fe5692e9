// leak_test.cpp: can a ray slip through a closed mesh past any of the kernels?
//
// The rays of support/leak_rays.h, shared among the instruction sets: a million, or ten million when
// BOXWOOD_LONG_TESTS is 1. Every crossing must count once, and all calls must agree. tests/leak_hunt shoots a
// billion.
#include <atomic>
#include <cstdlib>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "kernel_oracle.h"
#include "support/leak_rays.h"

namespace boxwood::simd {
namespace {

using boxwood::test::AimedRay;
using boxwood::test::bodies;
using boxwood::test::Body;
using boxwood::test::kOffsets;

std::size_t ray_budget() {
  const char* wish = std::getenv("BOXWOOD_LONG_TESTS");
  return wish && std::string(wish) == "1" ? 10'000'000 : 1'000'000;
}

struct Count {
  std::atomic<std::size_t> rays = 0, leaks = 0, miscounted = 0, disagreements = 0, handed_back = 0;
};

/// Shoots about `count` rays, in parallel.
void shoot(const Kernels& kernels, const boxwood::test::Mesh& mesh, Vec3 inside, float clearance,
           std::size_t count, Count& result) {
  const std::vector<Triangle> triangles = boxwood::test::triangles(mesh);
  const Bvh bvh = build(boxes(triangles));
  const Box3 bounds = bvh.bounds();
  const std::unique_ptr<TriangleTree> trees[] = {
      test::pack(kernels.width, bvh, triangles, {}, Layout::full),
      test::pack(kernels.width, bvh, triangles, {}, Layout::compact)};

  constexpr std::size_t kBlock = 1000;
  parallel_for(default_executor(), 0, (count + kBlock - 1) / kBlock, 1, [&](std::size_t block) {
    const auto& tree = trees[block % 2];
    Random random(2, block);
    std::vector<AimedRay> aimed;
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < kBlock; ++i) {
      aimed.push_back(boxwood::test::aim(mesh, inside, clearance, 2, random));
      rays.push_back(aimed.back().ray);
    }
    std::vector<TriangleHit> closest(kBlock), all;
    const auto any = std::make_unique<bool[]>(kBlock);
    std::vector<std::uint32_t> unusual;
    kernels.closest_hits(*tree, rays, bounds, closest.data(), nullptr, unusual);
    kernels.any_hits(*tree, rays, bounds, any.get(), unusual);

    std::size_t leaks = 0, miscounted = 0, disagreements = 0;
    for (std::size_t i = 0; i < kBlock; ++i) {
      TriangleHit single;
      bool is_any = false;
      all.clear();
      kernels.closest_hit(*tree, rays[i], bounds, single);
      kernels.any_hit(*tree, rays[i], bounds, is_any);
      kernels.all_hits(*tree, rays[i], bounds, all);
      leaks += aimed[i].must_hit && !closest[i].is_hit();
      disagreements += !test::same_bits(single.t, closest[i].t) || single.is_hit() != closest[i].is_hit() ||
                       (single.is_hit() && single.key != closest[i].key);
      disagreements += is_any != single.is_hit() || any[i] != is_any || all.empty() == is_any;

      const PreparedRay prepared(rays[i], bounds);
      int sum = 0;
      bool has_first = !single.is_hit();
      for (const TriangleHit& hit : all) {
        sum += boxwood::test::crossing_sign(prepared, tree->triangle(hit.block, hit.lane));
        has_first |= hit.key == single.key && test::same_bits(hit.t, single.t);
        disagreements += hit.t < single.t;
      }
      disagreements += !has_first;
      miscounted +=
          sum != int(aimed[i].starts_inside) || all.size() % 2 != std::size_t(aimed[i].starts_inside);
    }
    result.rays += kBlock;
    result.leaks += leaks;
    result.miscounted += miscounted;
    result.disagreements += disagreements;
    result.handed_back += unusual.size();
  });
}

TEST(KernelLeaks, NoRayGetsThroughAndEachCrossingCountsOnce) {
  const std::size_t shares = available_kernels().size() * bodies().size() * std::size(kOffsets);
  std::size_t rays = 0;
  for (const Kernels* kernels : available_kernels())
    for (const Body& body : bodies())
      for (const Vec3 offset : kOffsets) {
        Count here;
        shoot(*kernels, boxwood::test::placed(body.mesh, 1, offset), body.inside + offset, body.clearance,
              ray_budget() / shares, here);
        SCOPED_TRACE(body.name + " at " + std::to_string(offset.x) + ", " + std::string(kernels->name));
        EXPECT_EQ(here.leaks, 0u);
        EXPECT_EQ(here.miscounted, 0u);
        EXPECT_EQ(here.disagreements, 0u);
        EXPECT_EQ(here.handed_back, 0u);
        rays += here.rays;
      }
  EXPECT_TRUE(available_kernels().empty() || rays > ray_budget() * 9 / 10);
  RecordProperty("rays", std::to_string(rays));
}

}  // namespace
}  // namespace boxwood::simd
