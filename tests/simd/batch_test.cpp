// batch_test.cpp: does a batch say what single calls say, whatever its size and whatever is in it?
//
// The kernels for batches keep a fixed number of rays in flight, put aside rays that are not ordinary, and
// have a short stack: sizes around that number, unusual rays at every place, and trees too deep for the
// stack.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/core/random.h"
#include "boxwood/simd/validate.h"
#include "kernel_oracle.h"
#include "support/meshes.h"
#include "support/shapes.h"

namespace boxwood::simd {
namespace {

/// Rays through [-1, 1]^3: most hit something of a mesh in there, and the work for them differs much.
std::vector<Ray> mixed_rays(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 from = random.in_box(splat(-2), splat(2));
    Ray ray{from, 0, random.in_box(splat(-1), splat(1)) - from, kInfinity};
    if (random.below(4) == 0) ray.t_max = random.uniform();
    if (random.below(4) == 0) ray.t_min = min(ray.t_max, random.uniform());
    if (random.below(8) == 0) ray.origin = {50, 50, 50};  // most of these miss everything
    rays.push_back(ray);
  }
  return rays;
}

Ray unusual_ray(Random& random) {
  constexpr float kBad[] = {std::numeric_limits<float>::quiet_NaN(), kInfinity, 1e30f};
  Ray ray{{0, 0, 0}, 0, {0, 0, 0}, kInfinity};
  if (const std::uint32_t kind = random.below(4); kind < 3) {
    ray.direction = {0, 1, 0};
    ray.origin[static_cast<int>(random.below(3))] = kBad[kind];
  }
  return ray;
}

struct Case {
  std::vector<Triangle> triangles;
  Bvh bvh;

  explicit Case(std::vector<Triangle> input) : triangles(std::move(input)), bvh(build(boxes(triangles))) {}
};

TEST(KernelBatches, EverySize) {
  const Case rough(boxwood::test::triangles(boxwood::test::rough_sphere(4)));
  for (const Kernels* kernels : available_kernels()) {
    const auto tree = test::pack(kernels->width, rough.bvh, rough.triangles);
    for (const std::size_t size : {0, 1, 2, 3, 7, 8, 16, 17, 31, 32, 33, 63, 64, 65, 100, 10'000}) {
      const std::vector<bool> handed_back =
          test::expect_batch_equals_single(*kernels, *tree, mixed_rays(size, size), rough.bvh.bounds());
      EXPECT_EQ(std::count(handed_back.begin(), handed_back.end(), true), 0);
    }
  }
}

TEST(KernelBatches, UnusualRaysAnywhere) {
  const Case soup(boxwood::test::triangles(boxwood::test::triangle_soup(3000)));
  Random random(1);
  for (const Kernels* kernels : available_kernels()) {
    const auto tree = test::pack(kernels->width, soup.bvh, soup.triangles);
    const auto check = [&](std::vector<Ray> rays, const std::vector<bool>& is_unusual) {
      for (std::size_t i = 0; i < rays.size(); ++i)
        if (is_unusual[i]) rays[i] = unusual_ray(random);
      EXPECT_EQ(test::expect_batch_equals_single(*kernels, *tree, rays, soup.bvh.bounds()), is_unusual);
    };
    // One at each place; all but one; all; and shares of many.
    for (const std::size_t size : {1, 31, 32, 33, 70})
      for (std::size_t at = 0; at < size; ++at) {
        std::vector<bool> one(size, false), all_but_one(size, true);
        one[at] = true;
        all_but_one[at] = false;
        check(mixed_rays(size, at), one);
        check(mixed_rays(size, at), all_but_one);
      }
    for (const std::size_t size : {32, 100, 5000}) check(mixed_rays(size, 3), std::vector<bool>(size, true));
    for (const std::uint32_t share : {2, 10, 100}) {
      std::vector<bool> some(10'000);
      for (std::size_t i = 0; i < some.size(); ++i) some[i] = random.below(share) == 0;
      check(mixed_rays(some.size(), share), some);
    }
  }
}

// Nothing may stay behind from a batch in the memory that the next one uses.
TEST(KernelBatches, OneAfterTheOther) {
  const Case large(boxwood::test::triangles(boxwood::test::rough_sphere(4))),
      small(boxwood::test::random_shapes<Triangle>(3, 1));
  for (const Kernels* kernels : available_kernels())
    for (int i = 0; i < 20; ++i)
      for (const Case* world : {&large, &small}) {
        const auto tree = test::pack(kernels->width, world->bvh, world->triangles);
        const auto size = static_cast<std::size_t>(7 + 13 * i);
        test::expect_batch_equals_single(*kernels, *tree, mixed_rays(size, 1), world->bvh.bounds());
      }
}

TEST(KernelBatches, LeavesOfSeveralBlocks) {
  const std::vector<Triangle> triangles = boxwood::test::coincident_shapes<Triangle>(12, 2);
  const Bvh bvh = build(boxes(triangles), {.leaf_size = 12});
  const Vec3 middle = (triangles[0].a + triangles[0].b + triangles[0].c) * (1.0f / 3);
  std::vector<Ray> rays = mixed_rays(50, 8);
  for (Ray& ray : rays) ray.direction = middle - ray.origin;
  const std::vector<test::Answer> expected = test::brute_answers(triangles, {}, rays);
  for (const Kernels* kernels : available_kernels()) {
    const auto tree = test::pack(kernels->width, bvh, triangles);
    EXPECT_EQ(tree->block_count(), 3u);
    EXPECT_GT(test::expect_equal_to(*kernels, *tree, rays, bvh.bounds(), expected).hits, 10u);
  }
}

/// A chain of `levels` nodes: all children of each but the first are leaves, and the first holds all that is
/// below, nearest to the viewer. A ray along +x enters every box, so it leaves behind as much as it can.
template <int W>
WideBvh<W> chain(int levels, std::vector<Triangle>& triangles) {
  WideBvh<W> wide;
  wide.nodes.resize(static_cast<std::size_t>(levels));
  const int depth = levels * W;  // x of the farthest triangle is at most this
  for (int level = levels - 1; level >= 0; --level) {
    WideNode<W>& node = wide.nodes[static_cast<std::size_t>(level)];
    const bool is_last = level == levels - 1;
    if (!is_last) node.set(0, wide.box, ChildRef::node(static_cast<std::uint32_t>(level + 1)));
    for (int c = is_last ? 0 : 1; c < W; ++c) {
      const float x = float(depth - level * W - (W - c)) + 1;
      // Every third has a hole where the rays along +x pass, so that nothing is culled for long.
      const float y = c % 3 == 0 ? 0.5f : -1.0f;
      const Triangle triangle{{x, y, -1}, {x, 1, -1}, {x, 1, 3}};
      const auto id = static_cast<std::uint32_t>(triangles.size());
      triangles.push_back(triangle);
      node.set(c, Box3{{x, -1, -1}, {x, 1, 3}}, ChildRef::leaf(id, 1));
      wide.slots.insert(wide.slots.end(), kBlockWidth, PrimId(id));
      wide.box.extend(node.box(c));
    }
  }
  return wide;
}

template <int W>
void expect_chain_right(const Kernels& kernels, int levels) {
  SCOPED_TRACE(std::to_string(levels) + " levels, " + std::string(kernels.name));
  std::vector<Triangle> triangles;
  const WideBvh<W> wide = chain<W>(levels, triangles);
  const TriangleTree tree(wide, triangles, {}, serial_executor());
  EXPECT_EQ(validate(tree), "");
  EXPECT_EQ(tree.max_stack(), levels * (W - 1) + 1);
  std::vector<Ray> rays;
  Random random(3);
  for (int i = 0; i < 40; ++i) {
    const float y = i % 2 ? random.uniform(-1, 0.4f) : random.uniform(-1, 1), z = random.uniform(-1, 3);
    rays.push_back({{-1, y, z}, 0, {1, 0, 0}, kInfinity});
    rays.push_back({{-1, -1, z}, 0, {1, 0, 0}, kInfinity});  // along the lower side of every box
    rays.push_back({{1e4f, y, z}, 0, {-1, 0, -0.0f}, kInfinity});
    rays.push_back({{-1, y, z}, 0, random.in_box({0, -0.01f, -0.01f}, {1, 0.01f, 0.01f}), kInfinity});
    rays.push_back({{-1, y, z}, random.uniform(0, 300), {1, 0, 0}, random.uniform(300, 800)});
    rays.push_back({{-1, y, -1.0f - z}, 0, {1, 0, 0}, kInfinity});
  }
  const test::Checked checked =
      test::expect_equal_to(kernels, tree, rays, wide.box, test::brute_answers(triangles, {}, rays));
  EXPECT_GT(checked.hits, 20u);
  EXPECT_LT(checked.hits, checked.rays);
}

// Up to as many levels as a tree may have, which all leave as much behind as they can; the short stack ends
// somewhere in between.
TEST(KernelBatches, ChainsOfAnyDepth) {
  constexpr int kMostLevels = kMaxWideDepth + 1;
  int deepest = 0;
  for (const Kernels* kernels : available_kernels())
    for (const int levels :
         {1, 2, 5, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 30, 39, 40, 41, 42, 43, 60, kMostLevels}) {
      with_width(kernels->width, [&](auto w) { expect_chain_right<w()>(*kernels, levels); });
      deepest = levels;
    }
  EXPECT_TRUE(available_kernels().empty() || deepest == kMostLevels);
}

// A builder's own deep tree: each triangle is as large as all before it together.
TEST(KernelBatches, GeometricSeriesAlongTheLongestAxis) {
  std::vector<Triangle> series;
  for (int i = -110; i < 35; ++i) {
    const float x = std::ldexp(1.0f, i);
    series.push_back({{x, 0, 0}, {1.5f * x, x, 0}, {1.25f * x, 0, x}});
    series.push_back({{x, 0, x}, {1.5f * x, x, 0}, {1.25f * x, 0, 0}});
  }
  std::vector<Ray> rays;
  Random random(4);
  for (const Triangle& t : series) {
    const float size = t.a.x;
    const Vec3 to = (t.a + t.b + t.c) * (1.0f / 3);
    rays.push_back({to - Vec3{0, 0, size}, 0, {0, 0, 1}, kInfinity});
    rays.push_back({{-1, 0, 0}, 0, {1, 0x1p-20f, 0x1p-20f}, size});
    rays.push_back({{0, 0, 0}, 0, to * (1 / size), kInfinity});
    rays.push_back({{0x1p35f, size, size * 0.5f}, 0, {-1, 0, random.uniform(-1e-12f, 1e-12f)}, kInfinity});
  }
  BuildOptions options{.method = Method::longest_axis, .max_depth = kMaxDepth, .leaf_size = 1};
  const Bvh bvh = build(boxes(series), options);
  const std::vector<test::Answer> expected = test::brute_answers(series, {}, rays);
  for (const Kernels* kernels : available_kernels()) {
    const auto tree = test::pack(kernels->width, bvh, series);
    EXPECT_GT(test::expect_equal_to(*kernels, *tree, rays, bvh.bounds(), expected).hits, 200u);
  }
}

}  // namespace
}  // namespace boxwood::simd
