// hash_test.cpp: does every machine find the same hits, to the bit?
//
// A million hits become one number: for each instruction set of this machine, single calls and batches, and
// any number of threads. The number stands here, so other machines and other instruction sets are held to it
// too. Nothing that goes into it depends on a mathematical library: only on +, -, *, / and the square root,
// which IEEE 754 rounds exactly, and on PCG32.
#include <bit>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/core/random.h"
#include "kernel_oracle.h"
#include "support/meshes.h"

namespace boxwood::simd {
namespace {

constexpr std::size_t kRays = 1'000'000, kPart = 10'000;

/// Changes only when the contract does (shape/triangle.h, shape/gate.h), or the rays below.
constexpr std::uint64_t kHash = 5767897452044279078u;

/// Closed, so that a ray from inside hits.
struct World {
  std::vector<Triangle> triangles;
  Bvh bvh;
  std::vector<Ray> rays;

  World() {
    for (const auto& [mesh, offset] : {std::pair{boxwood::test::rough_sphere(5), Vec3{0, 0, 0}},
                                       std::pair{boxwood::test::sponge(2), Vec3{2.5f, 0, 0}}}) {
      const std::vector<Triangle> more = boxwood::test::triangles(boxwood::test::placed(mesh, 1, offset));
      triangles.insert(triangles.end(), more.begin(), more.end());
    }
    bvh = build(boxes(triangles));

    // Anywhere, along axes, and at vertices and edges; all from inside the sphere, where each ray hits.
    Random random(20);
    while (rays.size() < kRays) {
      const Vec3 from = random.in_box(splat(-0.1f), splat(0.1f));
      Vec3 way = random.in_box(splat(-1), splat(1));
      const Triangle& t = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
      if (const std::uint32_t kind = random.below(8); kind == 0) {
        way = {0, 0, 0};
        way[static_cast<int>(random.below(3))] = random.below(2) ? 1.0f : -1.0f;
      } else if (kind == 1) {
        way = t.a - from;
      } else if (kind == 2) {
        way = (t.a * 0.5f + t.b * 0.5f) - from;
      }
      if (max_component(abs(way)) > 0) rays.push_back({from, 0, way, kInfinity});
    }
  }
};

const World& world() {
  static const World all;
  return all;
}

/// Fowler, Noll and Vo's, over t and key.
std::uint64_t hash_of(const std::vector<TriangleHit>& hits) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const TriangleHit& hit : hits)
    for (const std::uint32_t word : {std::bit_cast<std::uint32_t>(hit.t), hit.key})
      for (int byte = 0; byte < 4; ++byte) hash = (hash ^ (word >> 8 * byte & 255)) * 1099511628211ull;
  return hash;
}

TEST(KernelHash, TheSameOnEveryTargetInBatchesAndOnAnyNumberOfThreads) {
  const World& w = world();
  const Box3 bounds = w.bvh.bounds();
  for (const Kernels* kernels : available_kernels())
    for (const Layout layout : test::kLayouts) {
      SCOPED_TRACE(layout == Layout::full ? "full" : "compact");
      const auto tree = test::pack(kernels->width, w.bvh, w.triangles, {}, layout);
      std::vector<TriangleHit> hits(kRays);
      for (std::size_t i = 0; i < kRays; ++i)
        ASSERT_TRUE(kernels->closest_hit(*tree, w.rays[i], bounds, hits[i])) << kernels->name;
      std::size_t hit_count = 0;
      for (const TriangleHit& hit : hits) hit_count += hit.is_hit();
      EXPECT_EQ(hit_count, kRays) << kernels->name;
      EXPECT_EQ(hash_of(hits), kHash) << kernels->name << ", single rays";

      for (const int threads : {1, 2, 4}) {
        const auto executor = make_executor(threads);
        hits.assign(kRays, {});
        parallel_for(*executor, 0, kRays / kPart, 1, [&](std::size_t part) {
          std::vector<std::uint32_t> unusual;
          kernels->closest_hits(*tree, std::span(w.rays).subspan(part * kPart, kPart), bounds,
                                hits.data() + part * kPart, nullptr, unusual);
          if (!unusual.empty()) hits[part * kPart] = {};
        });
        EXPECT_EQ(hash_of(hits), kHash) << kernels->name << ", batches on " << threads << " threads";
      }
    }
}

// A share of the same hits by brute force, so that the number is not just what some kernel said once.
TEST(KernelHash, BruteForceSaysTheSame) {
  const World& w = world();
  const std::span<const Ray> some = std::span(w.rays).first(500);
  const std::vector<test::Answer> expected = test::brute_answers(w.triangles, {}, some);
  for (const Kernels* kernels : available_kernels()) {
    const auto tree = test::pack(kernels->width, w.bvh, w.triangles);
    EXPECT_EQ(test::expect_equal_to(*kernels, *tree, some, w.bvh.bounds(), expected).hits, some.size());
  }
}

}  // namespace
}  // namespace boxwood::simd
