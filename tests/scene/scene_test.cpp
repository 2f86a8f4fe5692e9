// Scenes against a search without any tree, batches against single rays, and what is refused at the door.
#include "boxwood/scene/scene.h"

#include <thread>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/gallery/gallery.h"
#include "boxwood/query/distance.h"
#include "scene_oracle.h"

namespace boxwood {
namespace {

using test::all_hits_without_trees;

TriangleMesh random_mesh(Random& random, int triangles, float size) {
  TriangleMesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const Vec3 center = random.in_box(splat(-1), splat(1));
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(center + random.in_box(splat(-size), splat(size)));
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.indices.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TriangleMesh flat_square() {
  return {{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
}

/// Everything that a scene can hold: meshes and shapes, in the world and under turned, mirrored, stretched
/// and flat-lying transforms, some in the same place.
SceneDesc mixed_scene() {
  Random random(7);
  SceneDesc desc;
  const GeometryId soup = desc.add(random_mesh(random, 200, 0.3f));
  const GeometryId square = desc.add(flat_square());
  const GeometryId balls =
      desc.add(std::vector<Sphere>{{{0, 0, 0}, 0.5f}, {{1, 0, 0}, 0.25f}, {{0, 0, 0}, 0.5f}});
  const GeometryId quads = desc.add(std::vector<Quad>{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}});
  const GeometryId blocks = desc.add(std::vector<Cuboid>{{{-0.2f, -0.2f, -0.2f}, {0.2f, 0.2f, 0.2f}},
                                                         {{0.2f, -0.2f, -0.2f}, {0.4f, 0.2f, 0.2f}}});
  const GeometryId disks =
      desc.add(std::vector<Disk>{{{0, 0, 0}, {0, 1, 0}, 1}, {{0, 0.5f, 0}, {1, 1, 0}, 0.3f}});
  const GeometryId mixed =
      desc.add(std::vector<AnyShape>{Sphere{{2, 2, 2}, 1}, Cuboid{{1, 1, 1}, {2, 2, 2}}});

  for (const GeometryId id : {soup, square, balls, quads, blocks, disks, mixed}) {
    desc.add({id, Affine3::identity(), {}});
    desc.add({id, Affine3::identity(), {}});  // twice in one place: ties by instance
    desc.add({id, Affine3::translation({3, 0, 0}), {}});
    desc.add({id, Affine3::translation({3, 0, 0}), {}});
    desc.add({id, Affine3::translation({0, 3, 1}) * Affine3::rotation({1, 2, 3}, 33), {}});
    desc.add(
        {id,
         Affine3::translation({-3, 0, 0}) * Affine3::scale({-1, 0.3f, 2}) * Affine3::rotation({0, 1, 1}, 70),
         {}});
    desc.add({id, Affine3::translation({0, -300, 0}) * Affine3::scale(100), {}});
  }
  return desc;
}

/// Random rays, rays along the axes through round coordinates, and rays that start on what they may hit.
std::vector<Ray> hard_rays(int count) {
  Random random(11);
  std::vector<Ray> rays;
  const float round[] = {-3, -1, -0.5f, -0.2f, 0, 0.2f, 0.5f, 1, 3};
  for (int i = 0; i < count; ++i) {
    Ray ray{random.in_box(splat(-6), splat(6)), 0, random.direction()};
    if (i % 4 == 1) ray.direction = random.in_box(splat(-4), splat(4)) - ray.origin;
    if (i % 4 == 2) {
      for (int k = 0; k < 3; ++k) ray.origin[k] = round[random.below(9)];
      ray.direction = {0, 0, 0};
      ray.direction[static_cast<int>(random.below(3))] = random.below(2) ? 1.0f : -1.0f;
    }
    if (i % 4 == 3) {
      for (int k = 0; k < 3; ++k) ray.origin[k] = round[random.below(9)];
      ray.direction = Vec3{round[random.below(9)], round[random.below(9)], round[random.below(9)]};
    }
    if (i % 7 == 0) ray.t_min = random.uniform(0, 3);
    if (i % 5 == 0) ray.t_max = random.uniform(0, 6);
    rays.push_back(ray);
  }
  return rays;
}

Hit without_normal(Hit hit) {
  hit.normal = {};
  return hit;
}

TEST(Scene, AnswersAsIfItHadNoTrees) {
  const Scene scene(mixed_scene());
  std::size_t crossings = 0;
  std::vector<Hit> all;
  for (const Ray& ray : hard_rays(20000)) {
    const std::vector<Hit> expected = all_hits_without_trees(scene, ray);
    crossings += expected.size();

    scene.all_hits(ray, all);
    ASSERT_EQ(all.size(), expected.size());
    for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(without_normal(all[i]), expected[i]);
    ASSERT_EQ(without_normal(scene.closest_hit(ray)), expected.empty() ? Hit{} : expected[0]);
    ASSERT_EQ(scene.any_hit(ray), !expected.empty());
  }
  EXPECT_GT(crossings, 20000u);
}

TEST(Scene, AnswersDoNotDependOnTheBuilder) {
  BuildOptions textbook;
  textbook.method = Method::longest_axis;
  textbook.leaf_size = 1;
  const Scene a(mixed_scene()), b(mixed_scene(), textbook);
  for (const Ray& ray : hard_rays(5000)) ASSERT_EQ(a.closest_hit(ray), b.closest_hit(ray));
}

// In the `best` tree long triangles are cut, and parts of them stand in many leaves.
TEST(Scene, AnswersDoNotDependOnPartsOfTriangles) {
  const Scene whole(gallery::make("soup:40000")), parts(gallery::make("soup:40000"), BuildOptions::best());
  ASSERT_TRUE(parts.parts().world.triangles.has_parts());
  ASSERT_FALSE(whole.parts().world.triangles.has_parts());
  Random random(17);
  std::vector<Hit> some, others;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 from = random.in_box(whole.bounds().lower, whole.bounds().upper);
    const Ray ray{from, 0, random.direction(), kInfinity};
    whole.all_hits(ray, some);
    parts.all_hits(ray, others);
    ASSERT_EQ(some, others);
    ASSERT_EQ(whole.count_hits(ray), parts.count_hits(ray));
    ASSERT_EQ(whole.closest_point(from), parts.closest_point(from));
    // From a surface, where distances are all rounding.
    const ScenePoint point = whole.closest_point(from);
    ASSERT_EQ(whole.closest_point(point.position), parts.closest_point(point.position));
  }
}

TEST(Scene, BatchesGiveTheSameBitsAsSingleRays) {
  const Scene scene(mixed_scene());
  const std::vector<Ray> rays = hard_rays(5000);
  std::vector<Hit> hits(rays.size());
  const std::unique_ptr<bool[]> lit(new bool[rays.size()]);
  for (int threads : {1, 2, 5}) {
    const auto executor = make_executor(threads);
    scene.closest_hit(rays, hits, executor.get());
    scene.any_hit(rays, std::span(lit.get(), rays.size()), executor.get());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(hits[i], scene.closest_hit(rays[i]));
      ASSERT_EQ(lit[i], scene.any_hit(rays[i]));
    }
  }
  EXPECT_THROW(scene.closest_hit(rays, std::span(hits).first(10)), std::invalid_argument);
}

TEST(Scene, ReadersAreFree) {
  const Scene scene(mixed_scene());
  const std::vector<Ray> rays = hard_rays(2000);
  std::vector<Hit> expected(rays.size());
  scene.closest_hit(rays, expected, &serial_executor());
  std::vector<std::thread> threads;
  std::array<int, 4> wrong{};
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([&, k] {
      for (std::size_t i = 0; i < rays.size(); ++i) wrong[k] += scene.closest_hit(rays[i]) != expected[i];
    });
  for (std::thread& thread : threads) thread.join();
  for (const int count : wrong) EXPECT_EQ(count, 0);
}

TEST(Scene, NormalsAreUnitAndPointOutwardAlsoWhenMirrored) {
  SceneDesc desc;
  const GeometryId ball = desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}});
  desc.add({ball, Affine3::translation({5, 0, 0}) * Affine3::scale({-2, 1, 1}), {}});
  const Scene scene(desc);
  const Hit hit = scene.closest_hit({{5, 0.5f, -10}, 0, {0, 0, 1}});
  ASSERT_TRUE(hit.is_hit());
  EXPECT_NEAR(length(hit.normal), 1, 1e-6);
  EXPECT_LT(hit.normal.z, 0);
  EXPECT_GT(hit.normal.y, 0);
}

TEST(Scene, EmptySceneAndUnusableRaysMiss) {
  const Scene empty{SceneDesc{}};
  EXPECT_FALSE(empty.closest_hit({{0, 0, 0}, 0, {0, 0, 1}}).is_hit());
  EXPECT_TRUE(empty.bounds().is_empty());
  EXPECT_FALSE(empty.closest_point({0, 0, 0}).instance_id.is_valid());

  SceneDesc desc;
  desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}});
  const Scene scene(desc);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Ray& ray :
       {Ray{{nan, 0, 0}, 0, {0, 0, 1}}, Ray{{0, 0, 0}, 0, {0, nan, 1}}, Ray{{0, 0, 0}, 0, {0, 0, 0}},
        Ray{{0, 0, 0}, nan, {0, 0, 1}}, Ray{{0, 0, 0}, 0, {0, 0, 1}, nan}, Ray{{0, 0, 0}, 3, {0, 0, 1}, 2},
        Ray{{kInfinity, 0, 0}, 0, {0, 0, 1}}, Ray{{0, 0, 0}, 0, {0, 0, kInfinity}}}) {
    EXPECT_FALSE(scene.closest_hit(ray).is_hit());
    EXPECT_FALSE(scene.any_hit(ray));
  }
}

TEST(Scene, RefusesWhatIsWrongAtTheDoor) {
  const auto message = [](const SceneDesc& desc) -> std::string {
    try {
      Scene scene(desc);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  SceneDesc nan_vertex;
  nan_vertex.add(TriangleMesh{
      {{0, 0, 0}, {1, 0, 0}, {0, std::numeric_limits<float>::quiet_NaN(), 0}}, {{0, 1, 2}}, {}, {}});
  EXPECT_NE(message(nan_vertex).find("geometry 0, vertex 2"), std::string::npos) << message(nan_vertex);

  SceneDesc bad_index;
  bad_index.add(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 3}}, {}, {}});
  EXPECT_NE(message(bad_index).find("geometry 0, triangle 1 has index 3"), std::string::npos)
      << message(bad_index);

  SceneDesc flat;
  flat.add({flat.add(flat_square()), Affine3::scale({1, 0, 1}), {}});
  EXPECT_NE(message(flat).find("instance 0"), std::string::npos) << message(flat);

  SceneDesc nothing;
  nothing.add({GeometryId(3), Affine3::identity(), {}});
  EXPECT_NE(message(nothing).find("geometry 3"), std::string::npos) << message(nothing);
}

TEST(Scene, ClosestPointEqualsTheBestOfAllPrimitives) {
  Random random(3);
  SceneDesc desc;
  const GeometryId soup = desc.add(random_mesh(random, 100, 0.2f));
  const GeometryId balls = desc.add(std::vector<Sphere>{{{0, 2, 0}, 0.5f}});
  desc.add({soup, Affine3::identity(), {}});
  desc.add({soup, Affine3::translation({2, 0, 0}) * Affine3::scale({1, 3, -1}), {}});
  desc.add(
      {balls, Affine3::translation({0, 2, 0}) * Affine3::rotation({1, 1, 0}, 20) * Affine3::scale(2), {}});
  const Scene scene(desc);
  const TriangleMesh& mesh = std::get<TriangleMesh>(desc.geometries[0].shapes);

  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random.in_box(splat(-5), splat(5));
    float best = kInfinity;
    for (std::size_t k = 0; k < mesh.indices.size(); ++k) {
      const Triangle t = triangle_of(mesh, PrimId(k));
      const Affine3& m = desc.instances[1].world_from_object;
      best = min(best, length(t.closest_point(p) - p));
      best = min(best, length(Triangle{m.point(t.a), m.point(t.b), m.point(t.c)}.closest_point(p) - p));
    }
    best = min(best, std::fabs(length(p - desc.instances[2].world_from_object.point({0, 2, 0})) - 1));
    const ScenePoint found = scene.closest_point(p);
    ASSERT_NEAR(found.distance, best, 1e-5f * (1 + best));
    ASSERT_NEAR(length(found.position - p), found.distance, 1e-5f * (1 + best));
    ASSERT_FALSE(scene.closest_point(p, 0.5f * best).instance_id.is_valid());
  }
}

// Two meshes that share corners, and spheres among them; ties go to the smallest instance, then primitive.
TEST(Scene, ClosestPointOfTheWorldIsThatOfBruteForce) {
  Random random(5);
  SceneDesc desc;
  const TriangleMesh soup = random_mesh(random, 150, 0.2f);
  std::vector<Sphere> balls;
  for (int i = 0; i < 10; ++i) balls.push_back({random.in_box(splat(-1), splat(1)), 0.05f});
  desc.add(soup);
  desc.add(balls);
  desc.add(soup);
  for (const bool is_compact : {false, true}) {
    BuildOptions options;
    options.is_compact = is_compact;
    const Scene scene(desc, options);
    for (int i = 0; i < 2000; ++i) {
      Vec3 p = random.in_box(splat(-2), splat(2));
      if (i % 3 == 0) p = soup.positions[random.below(static_cast<std::uint32_t>(soup.positions.size()))];
      ScenePoint best;
      const auto consider = [&](const ShapePoint& found, InstanceId instance) {
        if (found.distance < best.distance)
          best = {found.distance, found.position, instance, GeometryId(instance.value), found.prim_id};
      };
      for (std::size_t k = 0; k < soup.indices.size(); ++k)
        consider(nearest_point_of(triangle_of(soup, PrimId(k)), PrimId(k), p), InstanceId(0));
      for (std::size_t k = 0; k < balls.size(); ++k)
        consider(nearest_point_of(balls[k], PrimId(k), p), InstanceId(1));
      ASSERT_EQ(scene.closest_point(p), best);
      ASSERT_EQ(scene.closest_point(p, best.distance), best);
    }
  }
}

TEST(Scene, ClosestPointSaysWhatItCannotAnswer) {
  SceneDesc desc;
  desc.add({desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}}), Affine3::scale({1, 2, 1}), {}});
  EXPECT_THROW(Scene(desc).closest_point({0, 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace boxwood
