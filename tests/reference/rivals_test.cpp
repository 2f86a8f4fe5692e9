// Every rival against brute force: the same closest hit, bit for bit, and the same yes or no.
#include <algorithm>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/reference/brute_force.h"
#include "boxwood/reference/classic_bvh.h"
#include "boxwood/reference/flat_bvh.h"
#include "boxwood/reference/kd_tree.h"
#include "boxwood/reference/octree.h"
#include "boxwood/reference/uniform_grid.h"
#include "boxwood/shape/shape.h"
#include "reference/worlds.h"

namespace boxwood::reference {
namespace {

constexpr int kRays = 4000;

/// Shapes, rays, and what brute force says.
template <class Shape>
struct Trial {
  const std::vector<Shape>& shapes;
  std::vector<Ray> rays;
  Box3 bounds;
  std::vector<ShapeHit> expected;

  explicit Trial(const std::vector<Shape>& s) : shapes(s), rays(hard_rays(boxes(s), kRays)) {
    const BruteForce<Shape> truth{std::span<const Shape>(shapes)};
    bounds = truth.bounds();
    for (const Ray& ray : rays) expected.push_back(truth.closest_hit(ray));
  }
};

/// Counts the rays on which `structure` and brute force differ, and says what the first one is.
template <Structure S, class Shape>
void expect_equal(const S& structure, const Trial<Shape>& trial) {
  EXPECT_EQ(structure.bounds(), trial.bounds);
  int closest_differ = 0, any_differ = 0;
  for (std::size_t i = 0; i < trial.rays.size(); ++i) {
    const Ray& ray = trial.rays[i];
    const ShapeHit &expected = trial.expected[i], hit = closest_hit(structure, trial.shapes, ray);
    if (hit != expected && closest_differ++ == 0)
      ADD_FAILURE() << "ray " << i << " from " << ray.origin.x << " " << ray.origin.y << " " << ray.origin.z
                    << " along " << ray.direction.x << " " << ray.direction.y << " " << ray.direction.z
                    << ": t " << hit.t << " shape " << hit.prim_id.value << ", expected t " << expected.t
                    << " shape " << expected.prim_id.value;
    any_differ += any_hit(structure, trial.shapes, ray) != expected.is_hit();
  }
  EXPECT_EQ(closest_differ, 0);
  EXPECT_EQ(any_differ, 0);
}

template <class Shape>
void expect_all_equal(const std::vector<World<Shape>>& worlds) {
  for (const World<Shape>& world : worlds) {
    const Trial<Shape> trial(world.shapes);
    const std::vector<Box3> all = boxes(world.shapes);
    for (const std::uint32_t threshold : {0u, 4u}) {
      SCOPED_TRACE(world.name + ", classic BVH");
      ClassicBvh<Shape> classic;
      classic.build(world.shapes, 64, threshold);
      expect_equal(classic, trial);
    }
    {
      SCOPED_TRACE(world.name + ", flat BVH");
      const Bvh bvh = build(all, {.method = Method::longest_axis});
      expect_equal(UnorderedBvh(bvh), trial);
      expect_equal(OrderedBvh(bvh), trial);
    }
    {
      SCOPED_TRACE(world.name + ", kd-tree");
      expect_equal(KdTree(all), trial);
    }
    {
      SCOPED_TRACE(world.name + ", octree");
      expect_equal(Octree(all), trial);
    }
    {
      SCOPED_TRACE(world.name + ", uniform grid");
      expect_equal(UniformGrid(all), trial);
    }
  }
}

TEST(Rivals, AgreeWithBruteForceOnTriangles) {
  expect_all_equal(triangle_worlds());
}
TEST(Rivals, AgreeWithBruteForceOnSpheres) {
  expect_all_equal(sphere_worlds());
}
TEST(Rivals, AgreeWithBruteForceOnCuboids) {
  expect_all_equal(cuboid_worlds());
}

TEST(Rivals, AgreeWithBruteForceOnMixedShapes) {
  World<AnyShape> mixed{"mixed", {}};
  const auto balls = sphere_worlds();
  const auto blocks = cuboid_worlds();
  for (const Triangle& t : test::triangles(test::triangle_soup(200))) mixed.shapes.emplace_back(t);
  for (const Sphere& s : balls[2].shapes) mixed.shapes.emplace_back(s);
  for (const Cuboid& c : blocks[1].shapes) mixed.shapes.emplace_back(c);
  expect_all_equal(std::vector{mixed});
}

// A shape whose interval reaches past the cell in which it is found: a nearer one stands in the next cell.
TEST(Rivals, DoNotStopAtAHitBeyondTheCell) {
  std::vector<Triangle> shapes{{{-1, -1, 10}, {1, -1, -8}, {0, 1, 9}}};  // long, listed everywhere, hit late
  for (int i = 0; i < 200; ++i) {
    const float x = -1 + 0.01f * float(i);
    shapes.push_back({{x, -1, 5}, {x + 0.02f, -1, 5}, {x, 1, 5.1f}});
  }
  expect_all_equal(std::vector{World<Triangle>{"long and short", shapes}});
}

// The rays are worth asking: on every world that has something to hit, many hit and many miss.
TEST(Rivals, AreAskedRaysThatHitAndRaysThatMiss) {
  for (const World<Triangle>& world : triangle_worlds()) {
    if (world.shapes.empty()) continue;
    const Trial<Triangle> trial(world.shapes);
    const auto hits =
        std::count_if(trial.expected.begin(), trial.expected.end(), [](auto& hit) { return hit.is_hit(); });
    EXPECT_GT(hits, kRays / 20) << world.name;
    EXPECT_LT(hits, kRays - kRays / 20) << world.name;
  }
}

TEST(RivalStatistics, CountsEachShapeThatARayMeetsAgain) {
  RivalStatistics statistics;
  for (int ray = 0; ray < 2; ++ray) {
    statistics.begin_ray();
    for (const std::uint32_t id : {3u, 0u, 3u, 3u}) statistics.count_shape(PrimId(id));
  }
  EXPECT_EQ(statistics.shape_tests, 8u);
  EXPECT_EQ(statistics.repeated_tests, 4u);
}

// The seed's claim about space subdivision, and its other side: a BVH never tests a shape twice.
TEST(RivalStatistics, OnlySpaceSplittingRepeatsTests) {
  const std::vector<Triangle> shapes = test::triangles(test::icosphere(4));
  const std::vector<Box3> all = boxes(shapes);
  const std::vector<Ray> rays = hard_rays(all, kRays);
  const auto repeats = [&](const auto& structure) {
    RivalStatistics statistics;
    for (const Ray& ray : rays)
      (void)closest_hit(structure, std::span<const Triangle>(shapes), ray, statistics);
    EXPECT_GT(statistics.shape_tests, 0u);
    return statistics.repeated_tests;
  };
  ClassicBvh<Triangle> classic;
  classic.build(shapes, 64, 4);
  const Bvh bvh = build(all, {.method = Method::longest_axis});
  EXPECT_EQ(repeats(classic), 0u);
  EXPECT_EQ(repeats(UnorderedBvh(bvh)), 0u);
  EXPECT_EQ(repeats(OrderedBvh(bvh)), 0u);
  EXPECT_GT(repeats(KdTree(all)), 0u);
  EXPECT_GT(repeats(Octree(all)), 0u);
  EXPECT_GT(repeats(UniformGrid(all)), 0u);
}

// No rival may agree by testing everything.
TEST(Rivals, TestFewShapes) {
  const std::vector<Triangle> shapes = test::triangles(test::icosphere(5));
  const std::vector<Box3> all = boxes(shapes);
  std::vector<Ray> rays;
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 from = random.direction() * 3;
    rays.push_back({from, 0, random.in_box(splat(-1), splat(1)) - from});
  }
  const auto tests_per_ray = [&](const auto& structure) {
    RivalStatistics statistics;
    for (const Ray& ray : rays)
      (void)closest_hit(structure, std::span<const Triangle>(shapes), ray, statistics);
    return double(statistics.box_tests + statistics.shape_tests) / double(rays.size());
  };
  ClassicBvh<Triangle> classic;
  classic.build(shapes, 64, 4);
  const Bvh bvh = build(all, {.method = Method::longest_axis});
  EXPECT_LT(tests_per_ray(classic), 200);
  EXPECT_LT(tests_per_ray(UnorderedBvh(bvh)), 200);
  EXPECT_LT(tests_per_ray(OrderedBvh(bvh)), tests_per_ray(UnorderedBvh(bvh)));
  EXPECT_LT(tests_per_ray(KdTree(all)), 100);
  EXPECT_LT(tests_per_ray(Octree(all)), 150);
  EXPECT_LT(tests_per_ray(UniformGrid(all)), 150);
}

// Coincident shapes would fill every cell that they reach: the lists stay within their bound.
TEST(Rivals, DoNotListOverlappingShapesWithoutEnd) {
  Random random(3);
  for (const float spread : {0.0f, 0.3f}) {
    std::vector<Box3> heap;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 shift = random.in_box(splat(0), splat(spread));
      heap.push_back({shift, shift + splat(1)});
    }
    EXPECT_LE(KdTree(heap).reference_count(), 16 * heap.size());
    EXPECT_LE(Octree(heap).reference_count(), 16 * heap.size());
    EXPECT_LE(UniformGrid(heap).reference_count(), 16 * heap.size());
  }
}

TEST(ClassicBvh, IsTheTreeThatTheFlatOneIs) {
  const std::vector<Triangle> shapes = test::triangles(test::triangle_soup(2000));
  const std::vector<Box3> all = boxes(shapes);
  const Bvh bvh = build(all, {.method = Method::longest_axis, .max_depth = 64, .leaf_size = 4});
  ClassicBvh<Triangle> classic;
  classic.build(shapes, 64, 4);
  for (const Ray& ray : hard_rays(all, kRays)) {
    RivalStatistics of_classic, of_flat;
    (void)closest_hit(classic, std::span<const Triangle>(shapes), ray, of_classic);
    (void)closest_hit(UnorderedBvh(bvh), std::span<const Triangle>(shapes), ray, of_flat);
    ASSERT_EQ(of_classic.box_tests, of_flat.box_tests);
    ASSERT_EQ(of_classic.shape_tests, of_flat.shape_tests);
  }
}

TEST(ClassicBvh, ForgetsAnOldHitAndAnOldBuild) {
  const std::vector<Sphere> one{{{0, 0, 0}, 1}}, other{{{9, 0, 0}, 1}};
  ClassicBvh<Sphere> classic;
  classic.build(one, 8, 1);
  ShapeHit hit;
  EXPECT_TRUE(classic.hit({{0, 0, -5}, 0, {0, 0, 1}}, hit));
  EXPECT_EQ(hit.t, 4);
  EXPECT_FALSE(classic.hit({{0, 0, -5}, 0, {0, 0, -1}}, hit));
  EXPECT_FALSE(hit.is_hit());
  classic.build(other, 8, 1);
  EXPECT_FALSE(classic.hit({{0, 0, -5}, 0, {0, 0, 1}}, hit));
  classic.build({}, 8, 1);
  EXPECT_FALSE(classic.hit({{9, 0, -5}, 0, {0, 0, 1}}, hit));
}

TEST(ClassicBvh, StopsAtMaxDepth) {
  const std::vector<Triangle> shapes = test::triangles(test::icosphere(2));
  ClassicBvh<Triangle> classic;
  classic.build(shapes, 0, 1);
  RivalStatistics statistics;
  (void)closest_hit(classic, std::span<const Triangle>(shapes), {{0, 0, -5}, 0, {0, 0, 1}}, statistics);
  EXPECT_EQ(statistics.box_tests, 1u);
  EXPECT_EQ(statistics.shape_tests, shapes.size());
}

TEST(Rivals, RefuseABoxThatIsNotFinite) {
  std::vector<Box3> bad(3, Box3{{0, 0, 0}, {1, 1, 1}});
  bad[1].upper.y = kInfinity;
  for (const auto& build_one : std::vector<void (*)(std::span<const Box3>)>{
           [](std::span<const Box3> b) { KdTree tree(b); }, [](std::span<const Box3> b) { Octree tree(b); },
           [](std::span<const Box3> b) { UniformGrid grid(b); }}) {
    try {
      build_one(bad);
      ADD_FAILURE() << "an infinite box was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("box 1 "), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace boxwood::reference
