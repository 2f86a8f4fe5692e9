// oracle_test.cpp: every kernel on every builder's tree over triangles of every kind, under rays that are
// hard for them.
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "kernel_oracle.h"
#include "support/hard_rays.h"
#include "support/meshes.h"
#include "support/shapes.h"

namespace boxwood::simd {
namespace {

using boxwood::test::Make;

/// Rays whose numbers are at the ends of what floats can say: zeros of both signs, the smallest floats, and
/// limits among them.
void add_extreme_rays(std::vector<Ray>& rays, const std::vector<Vec3>& targets, float size, int count,
                      Random& random) {
  constexpr float kTiny[] = {0.0f,      -0.0f,  0x1p-149f, -0x1p-149f, 0x1p-140f,
                             0x1p-126f, 1e-30f, -1e-20f,   0x1p-30f};
  const auto tiny = [&] { return kTiny[random.below(std::size(kTiny))]; };
  for (int i = 0; i < count; ++i) {
    const Vec3 to = targets[random.below(static_cast<std::uint32_t>(targets.size()))];
    // Nearly along an axis, through a target.
    Vec3 way{tiny(), tiny(), tiny()};
    way[static_cast<int>(random.below(3))] = random.below(2) ? 1.0f : -1.0f;
    rays.push_back({to - way * size, 0, way, kInfinity});
    rays.push_back({to, tiny(), way, kInfinity});
    rays.push_back({to, tiny(), way, std::fabs(tiny())});
    rays.push_back({to - way * size, -0.0f, way, std::numeric_limits<float>::max()});
    rays.push_back({to - way * size, -kInfinity, way, kInfinity});
    // From next to the origin of coordinates.
    const Vec3 from{tiny(), tiny(), tiny()};
    rays.push_back({from, 0, to - from, kInfinity});
    // Short and long directions.
    const float scale = std::ldexp(1.0f, int(random.below(60)) - 30);
    rays.push_back({to - way * size, 0, way * scale, kInfinity});
  }
}

/// Rays that go the same way, one after the other, as batches trace them together: from one point along an
/// edge from corner to corner, along an axis from a small grid, and the same ray again and again.
void add_bundles(std::vector<Ray>& rays, const std::vector<Triangle>& triangles, float size, int count,
                 Random& random) {
  constexpr int kRun = 40;  // holds a whole bundle, wherever it begins
  for (int i = 0; i < count; ++i) {
    const Triangle& t = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
    const Vec3 from = t.a + random.in_box(splat(-1), splat(1)) * size * 10.0f;
    const int axis = static_cast<int>(random.below(3));
    Vec3 way{0, 0, 0};
    way[axis] = random.below(2) ? 1.0f : -1.0f;
    const float t_max = random.below(2) ? kInfinity : random.uniform(0, 2);
    for (int k = 0; k < kRun; ++k)
      rays.push_back({from, 0, t.a + (t.b - t.a) * (float(k) / 32) * 0.5f - from, t_max});
    for (int k = 0; k < kRun; ++k) {
      Vec3 to = t.a;
      to[(axis + 1) % 3] += (t.c - t.a)[(axis + 1) % 3] * float(k % 4) / 64;
      rays.push_back({to - way * size, 0, way, kInfinity});
    }
    for (int k = 0; k < kRun; ++k) rays.push_back({from, 0, t.b * 0.5f + t.c * 0.5f - from, kInfinity});
  }
}

std::vector<Vec3> corners_and_middles(const std::vector<Triangle>& triangles) {
  std::vector<Vec3> targets;
  for (const Triangle& t : triangles) {
    targets.push_back(t.a);
    targets.push_back(t.b * 0.5f + t.c * 0.5f);
  }
  return targets;
}

/// `effort`: ten of each kind of hard ray.
std::vector<Ray> rays_for(const std::vector<Triangle>& triangles, int effort = 3) {
  Random random(9, triangles.size());
  const reference::BruteForce brute(triangles);
  const std::vector<Vec3> targets =
      boxwood::test::targets_of(triangles, corners_and_middles(triangles), random);
  std::vector<Ray> rays = boxwood::test::hard_rays(targets, brute.bounds(), 10 * effort, random);
  add_extreme_rays(rays, targets, max_component(brute.bounds().extent()) * 2 + 1, 5 * effort, random);
  add_bundles(rays, triangles, max_component(brute.bounds().extent()) * 2, effort, random);
  boxwood::test::add_limited_rays(rays, brute, random);
  return rays;
}

void expect_equal(const std::string& name, const std::vector<Triangle>& triangles, int effort = 3) {
  const std::vector<Ray> rays = rays_for(triangles, effort);
  const test::Checked checked = test::expect_kernels_equal_to_brute_force(name, triangles, rays);
  if (available_kernels().empty()) return;
  EXPECT_GT(checked.hits, checked.rays / 20) << name << ": the rays are too easy";
  EXPECT_LT(checked.handed_back, checked.rays / 2) << name << ": too little is answered by kernels";
}

TEST(KernelOracle, ThisMachineHasKernels) {
#if defined(__x86_64__) || defined(__aarch64__)
  ASSERT_FALSE(available_kernels().empty());
#endif
  for (const Kernels* kernels : available_kernels()) {
    EXPECT_TRUE(kernels->width == 4 || kernels->width == 8 || kernels->width == 16) << kernels->name;
    EXPECT_NE(kernels->name, "other");
    RecordProperty(std::string(kernels->name), kernels->width);
  }
}

TEST(KernelOracle, ClosedMeshes) {
  for (const auto& [name, mesh] :
       {std::pair{"icosphere", boxwood::test::icosphere(2)}, std::pair{"torus", boxwood::test::torus(16, 9)},
        std::pair{"cube", boxwood::test::cube()}, std::pair{"grid cube", boxwood::test::cube(4)},
        std::pair{"sponge", boxwood::test::sponge(1)}, std::pair{"rough", boxwood::test::rough_sphere(2)}})
    for (const auto& [where, scale, offset] :
         {std::tuple{"", 1.0f, Vec3{0, 0, 0}}, std::tuple{", far away", 1.0f, Vec3{1e3f, -1e4f, 1e4f}},
          std::tuple{", small", 1e-6f, Vec3{0, 0, 0}}, std::tuple{", large", 1e8f, Vec3{0, 0, 0}}})
      expect_equal(std::string(name) + where,
                   boxwood::test::triangles(boxwood::test::placed(mesh, scale, offset)), 1);
}

TEST(KernelOracle, Soup) {
  expect_equal("soup", boxwood::test::triangles(boxwood::test::triangle_soup(700)), 6);
}

TEST(KernelOracle, OneTwoAFewTriangles) {
  for (const int count : {1, 2, 3, 4, 5, 8, 9, 12, 13, 17, 33})
    expect_equal(std::to_string(count), boxwood::test::random_shapes<Triangle>(count, 17), 2);
}

// Corners on integer coordinates: many crossings share their t, and the smallest key wins.
TEST(KernelOracle, LatticeTiesAndDegenerateTriangles) {
  expect_equal("lattice", boxwood::test::lattice_shapes<Triangle>(300, 2), 5);
  expect_equal("half degenerate", boxwood::test::degenerate_shapes<Triangle>(300, 3), 5);
}

TEST(KernelOracle, OnlyDegenerateTrianglesAreNeverHit) {
  Random random(8);
  std::vector<Triangle> triangles;
  for (int i = 0; i < 100; ++i) {
    const Vec3 a = boxwood::test::lattice_point(random), b = boxwood::test::lattice_point(random);
    triangles.push_back(i % 3 == 0 ? Triangle{a, a, a} : i % 3 == 1 ? Triangle{a, b, a} : Triangle{a, b, b});
  }
  const test::Checked checked =
      test::expect_kernels_equal_to_brute_force("degenerate", triangles, rays_for(triangles));
  EXPECT_EQ(checked.hits, 0u);
}

TEST(KernelOracle, FlatAlongAnAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Triangle> flat = boxwood::test::lattice_shapes<Triangle>(200, 4);
    for (Triangle& t : flat) t.a[axis] = t.b[axis] = t.c[axis] = axis == 1 ? 0.0f : 3.0f;
    expect_equal("flat", flat);
  }
}

// Needles, and large triangles that are seen nearly edge-on: t must be worked out in double.
TEST(KernelOracle, SliversAndBladesEdgeOn) {
  Random random(11);
  std::vector<Triangle> blades;
  for (int i = 0; i < 80; ++i) {
    const Vec3 a = random.in_box(splat(-1), splat(1)), along = random.direction();
    const float width = std::pow(10.0f, random.uniform(-7, -1));
    blades.push_back({a, a + along * random.uniform(1, 100), a + random.direction() * width});
  }
  std::vector<Ray> rays = rays_for(blades);
  for (const Triangle& blade : blades)
    for (int i = 0; i < 80; ++i) {
      // From a point in the plane to another, both moved off it by a few roundings or not at all.
      const auto in_plane = [&] {
        const float u = random.uniform(-1, 2), v = random.uniform(-1, 2);
        const Vec3 off = blade.normal() * (random.below(2) ? 0.0f : random.uniform(-1e-6f, 1e-6f));
        return blade.a + (blade.b - blade.a) * u + (blade.c - blade.a) * v + off;
      };
      const Vec3 from = in_plane(), to = in_plane();
      // Now and then again and again, so that batches trace it as a bundle.
      const Ray ray{from, 0, to - from, random.below(2) ? kInfinity : random.uniform()};
      rays.insert(rays.end(), i % 8 == 0 ? 40 : 1, ray);
    }
  boxwood::test::add_limited_rays(rays, reference::BruteForce(blades), random);
  EXPECT_GT(test::expect_kernels_equal_to_brute_force("blades", blades, rays).hits, 500u);
}

// A triangle that is crossed next to a corner at a low angle: t may lie behind the corner by more than the
// slack of the triangle's box and must be moved into it (shape/gate.h). One ray in thirty thousand is such.
TEST(KernelOracle, CornersBehindWhichTLies) {
  Random random(13);
  const auto point = [&random] { return random.in_box(splat(-1), splat(1)); };
  std::size_t moved = 0;
  for (int i = 0; i < 1'000'000 && moved < 8; ++i) {
    const Vec3 a = point(), b = point();
    const Triangle t{a, b, a + (b - a) * random.uniform() + point() * 0.5f};
    const Vec3 to = b + (a - b) * std::pow(10.0f, random.uniform(-7, -5)) +
                    (t.c - b) * std::pow(10.0f, random.uniform(-7, -5));
    const Vec3 beside = normalize(b - a) + point() * 0.5f, normal = t.normal();
    const Vec3 way = beside + normal * (std::pow(10.0f, random.uniform(-1.8f, -1)) - dot(beside, normal));
    const Ray ray{to - way * random.uniform(), 0, way, kInfinity};
    const PreparedRay prepared(ray, t.box());
    const Interval inside = prepared.interval(t.box());
    Crossing crossing;
    if (!intersect_triangle(prepared, t.a, t.b, t.c, crossing) || inside.is_empty() ||
        (crossing.t >= inside.entry && crossing.t <= inside.exit))
      continue;
    ++moved;
    const std::vector<Triangle> alone = {t};
    std::vector<Ray> rays(41, ray);  // so many, that batches trace it as a bundle
    boxwood::test::add_limited_rays(rays, reference::BruteForce(alone), random);
    EXPECT_GT(test::expect_kernels_equal_to_brute_force("corner", alone, rays).hits, 40u);
  }
  EXPECT_EQ(moved, 8u) << "no t had to be moved into its box: the rays are too easy";
}

TEST(KernelOracle, CopiesOfOneTriangle) {
  const std::vector<Triangle> copies = boxwood::test::coincident_shapes<Triangle>(10'000, 5);
  const reference::BruteForce brute(copies);
  Random random(6);
  std::vector<Ray> rays;
  const Vec3 inside = (copies[0].a + copies[0].b + copies[0].c) * (1.0f / 3);
  for (int i = 0; i < 4; ++i) {
    const Vec3 from = random.in_box(splat(-3), splat(3));
    rays.push_back({from, 0, inside - from, kInfinity});
    rays.push_back({from, 0, copies[0].a - from, kInfinity});
    rays.push_back({from, 0, random.direction(), kInfinity});
  }
  boxwood::test::add_limited_rays(rays, brute, random);
  EXPECT_GT(test::expect_kernels_equal_to_brute_force("copies", copies, rays).hits, 3u);
}

// Coordinates near 0, down to the smallest floats, are met by directions of ordinary size.
TEST(KernelOracle, TinyScales) {
  for (const float scale : {1e-30f, 1e-38f, 1e-42f}) {
    SCOPED_TRACE(scale);
    const std::vector<Triangle> triangles =
        boxwood::test::triangles(boxwood::test::placed(boxwood::test::rough_sphere(1), scale, {0, 0, 0}));
    Random random(3);
    std::vector<Ray> rays;
    for (const Vec3 to : corners_and_middles(triangles)) {
      const Vec3 from = random.in_box(splat(-1), splat(1)) * (random.below(2) ? scale * 2 : 1.0f);
      rays.push_back(
          {from, 0, random.below(2) ? random.direction() : (to - from) * (0.5f / scale), kInfinity});
      Vec3 way{0, 0, 0};
      way[static_cast<int>(random.below(3))] = random.below(2) ? 1.0f : -1.0f;
      rays.push_back({to - way * scale * 4.0f, 0, way, kInfinity});
      rays.push_back({from, 0, to - from, kInfinity});
    }
    boxwood::test::add_limited_rays(rays, reference::BruteForce(triangles), random);
    const test::Checked checked = test::expect_kernels_equal_to_brute_force("tiny", triangles, rays);
    EXPECT_GT(checked.hits, checked.rays / 20);
  }
}

// Whether the kernels may walk a tree depends on its size alone; at the largest, all that is answered is
// right.
TEST(KernelOracle, TheLargestOrdinaryScale) {
  const std::vector<Triangle> triangles =
      boxwood::test::triangles(boxwood::test::placed(boxwood::test::cube(3), 0x1p35f, {0, 0, 0}));
  Random random(4);
  std::vector<Ray> rays;
  for (const Vec3 to : corners_and_middles(triangles)) {
    const Vec3 from = random.in_box(splat(-0x1p35f), splat(0x1p35f));
    for (const float scale : {0x1p-30f, 1.0f, 0x1p-66f, 0x1p10f})
      rays.push_back({from, 0, (to - from) * scale, kInfinity});
    rays.push_back({from, 0, random.direction(), kInfinity});
    rays.push_back({from * 3.0f, 0, to - from * 3.0f, kInfinity});
  }
  boxwood::test::add_limited_rays(rays, reference::BruteForce(triangles), random);
  const test::Checked checked = test::expect_kernels_equal_to_brute_force("large", triangles, rays);
  EXPECT_GT(checked.hits, checked.rays / 5);
  EXPECT_GT(checked.handed_back, 0u);

  for (const auto& [scale, is_ordinary] :
       {std::pair{0x1p36f, true}, std::pair{0x1.000002p36f, false}, std::pair{1e30f, false}}) {
    const std::vector<Triangle> cube =
        boxwood::test::triangles(boxwood::test::placed(boxwood::test::cube(), scale, {0, 0, 0}));
    for (const int width : {4, 8})
      EXPECT_EQ(test::pack(width, build(boxes(cube)), cube)->is_ordinary(), is_ordinary) << scale;
  }
}

// The key of a triangle is what the caller says, and equal t goes to the smaller one, wherever it stands.
TEST(KernelOracle, KeysDecideTies) {
  std::vector<Triangle> triangles = boxwood::test::lattice_shapes<Triangle>(150, 6);
  triangles.insert(triangles.end(), triangles.begin(), triangles.end());
  triangles.insert(triangles.end(), triangles.begin(), triangles.begin() + 150);
  std::vector<std::uint32_t> keys(triangles.size());
  Random random(2);
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = static_cast<std::uint32_t>(i) * 9'500'000u;
  keys.back() = TriangleHit::kNone - 1;
  for (std::size_t i = keys.size(); i > 1; --i)
    std::swap(keys[i - 1], keys[random.below(static_cast<std::uint32_t>(i))]);
  const std::vector<Ray> rays = rays_for(triangles);
  EXPECT_GT(test::expect_kernels_equal_to_brute_force("keys", triangles, rays, keys).hits, 100u);
}

// A tree with spatial splits holds a triangle in several leaves, by the same key.
TEST(KernelOracle, OneTriangleInSeveralLeaves) {
  std::vector<Triangle> triangles = boxwood::test::triangles(boxwood::test::triangle_soup(200, 5));
  std::vector<std::uint32_t> keys;
  for (std::uint32_t i = 0; i < 200; ++i) keys.push_back(i);
  for (std::uint32_t i = 0; i < 200; i += 2) {
    triangles.push_back(triangles[i]);
    keys.push_back(i);
  }
  const std::vector<Ray> rays = rays_for(triangles);
  const std::vector<test::Answer> expected = test::brute_answers(triangles, keys, rays);
  const Bvh bvh = boxwood::test::random_tree(boxes(triangles), 3, 1);  // throws the copies far apart
  for (const Kernels* kernels : available_kernels()) {
    const auto tree = test::pack(kernels->width, bvh, triangles, keys);
    const test::Checked checked = test::expect_equal_to(*kernels, *tree, rays, bvh.bounds(), expected, true);
    EXPECT_GT(checked.hits, 100u);
  }
}

// Rays that floats could overflow on are handed back, by every call of every kernel, with nothing touched.
TEST(KernelOracle, UnusualRaysAreHandedBack) {
  const std::vector<Triangle> triangles = boxwood::test::triangles(boxwood::test::icosphere(2));
  const Bvh bvh = build(boxes(triangles));
  const float nan = std::numeric_limits<float>::quiet_NaN(), minus_nan = -nan;
  const Ray good{{0.1f, 0.2f, -3}, 0, {0, 0, 1}, kInfinity};
  std::vector<Ray> unusual;
  const auto add = [&](auto change) {
    Ray ray = good;
    change(ray);
    unusual.push_back(ray);
  };
  for (const float bad : {nan, minus_nan, kInfinity, -kInfinity, 1e30f, -1e30f, 0x1p60f, 0x1p37f})
    for (int axis = 0; axis < 3; ++axis) {
      add([&](Ray& ray) { ray.origin[axis] = bad; });
      add([&](Ray& ray) { ray.direction[axis] = bad; });
    }
  for (const float bad : {nan, minus_nan}) {
    add([&](Ray& ray) { ray.t_min = bad; });
    add([&](Ray& ray) { ray.t_max = bad; });
    add([&](Ray& ray) { ray.t_min = ray.t_max = bad; });
  }
  add([&](Ray& ray) { ray.t_min = 2, ray.t_max = 1; });
  add([&](Ray& ray) { ray.t_min = 2, ray.t_max = std::nextafter(2.0f, 0.0f); });
  add([&](Ray& ray) { ray.t_max = -1; });
  add([&](Ray& ray) { ray.t_min = -2, ray.t_max = -1; });
  add([&](Ray& ray) { ray.t_max = -kInfinity; });
  for (const float small : {0.0f, -0.0f, 0x1p-149f, 0x1p-60f, std::nextafter(0x1p-30f, 0.0f)})
    add([&](Ray& ray) { ray.direction = {small, -small, small}; });

  const std::vector<test::Answer> expected = test::brute_answers(triangles, {}, unusual);
  for (const Kernels* kernels : available_kernels()) {
    const auto tree = test::pack(kernels->width, bvh, triangles);
    const test::Checked checked = test::expect_equal_to(*kernels, *tree, unusual, bvh.bounds(), expected);
    EXPECT_EQ(checked.handed_back, unusual.size()) << kernels->name;
  }

  // At the very ends of what is ordinary nothing is.
  std::vector<Ray> ordinary{good};
  ordinary.push_back({good.origin, 0, {0, 0, 0x1p-30f}, kInfinity});
  ordinary.push_back({good.origin, 0, {0x1p-30f, 0, -0.0f}, kInfinity});
  ordinary.push_back({good.origin, 0, {0, 0, 0x1p35f}, kInfinity});
  ordinary.push_back({{0, 0, -0x1p35f}, 0, {0, 0, 1}, kInfinity});
  ordinary.push_back({good.origin, -kInfinity, good.direction, 0});
  ordinary.push_back({good.origin, -1, good.direction, 0});
  ordinary.push_back({good.origin, 0, good.direction, -0.0f});
  ordinary.push_back({good.origin, 3, good.direction, 3});
  const std::vector<test::Answer> answers = test::brute_answers(triangles, {}, ordinary);
  for (const Kernels* kernels : available_kernels()) {
    const auto tree = test::pack(kernels->width, bvh, triangles);
    const test::Checked checked = test::expect_equal_to(*kernels, *tree, ordinary, bvh.bounds(), answers);
    EXPECT_EQ(checked.handed_back, 0u) << kernels->name;
    EXPECT_GE(checked.hits, 2u);
  }
}

// The box that rays are prepared with may be that of a whole scene, larger than the tree: it decides the
// slack, and so the bits of t.
TEST(KernelOracle, BoundsOfALargerScene) {
  const std::vector<Triangle> triangles = boxwood::test::triangles(boxwood::test::rough_sphere(2));
  std::vector<Triangle> scene = triangles;
  scene.push_back({{500, 0, 0}, {500, 0, 0}, {500, -2000, 0}});  // degenerate: nothing but larger bounds
  const std::vector<Ray> rays = rays_for(triangles);
  const std::vector<test::Answer> expected = test::brute_answers(scene, {}, rays);
  const Bvh bvh = build(boxes(triangles));
  for (const Kernels* kernels : available_kernels()) {
    const auto tree = test::pack(kernels->width, bvh, triangles);
    const Box3 bounds = reference::BruteForce<Triangle>(scene).bounds();
    EXPECT_GT(test::expect_equal_to(*kernels, *tree, rays, bounds, expected).hits, 100u);
  }
}

}  // namespace
}  // namespace boxwood::simd
