// Scenes that are answered by kernels: batches and single rays, unusual rays, tiny and huge scenes, and many
// triangles in one place. tests/CMakeLists.txt runs all of this with each set of kernels.
#include <cmath>
#include <cstdlib>
#include <memory>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/gallery/gallery.h"
#include "boxwood/simd/validate.h"
#include "scene/scene_checks.h"

namespace boxwood {
namespace {

using test::check_all;
using test::mixed_rays;

class KernelScenes : public ::testing::TestWithParam<const char*> {};

TEST_P(KernelScenes, BatchesEqualSingleRaysAndListsCount) {
  const Scene scene(gallery::make(GetParam()));
  EXPECT_GT(check_all(scene, mixed_rays(scene.bounds(), 3'000, 1), false), 300u);
}

TEST_P(KernelScenes, AnswerUnusualRaysAsIfTheyHadNoTrees) {
  const Scene scene(gallery::make(GetParam()));
  EXPECT_GT(check_all(scene, mixed_rays(scene.bounds(), 200, 2), true), 20u);
}

TEST_P(KernelScenes, CompactScenesAnswerTheSame) {
  const SceneDesc desc = gallery::make(GetParam());
  BuildOptions options = BuildOptions::balanced();
  options.is_compact = true;
  const Scene compact(desc, options), full(desc);
  EXPECT_EQ(simd::validate(compact.parts().world.triangles), "");
  const std::vector<Ray> rays = mixed_rays(full.bounds(), 1'000, 3);
  EXPECT_GT(check_all(compact, rays, false), 100u);
  Random random(4);
  const bool has_closest_points = full.parts().closest_point_obstacle.empty();
  for (const Ray& ray : rays) {
    EXPECT_EQ(compact.closest_hit(ray), full.closest_hit(ray));
    if (!has_closest_points || HasFailure()) continue;
    const Vec3 point = random.in_box(full.bounds().lower, full.bounds().upper);
    const ScenePoint a = compact.closest_point(point), b = full.closest_point(point);
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.primitive_id, b.primitive_id);
  }
}

TEST(KernelScene, TreesOfPartsListEachCrossingOnce) {
  const Scene scene(gallery::make("soup:40000"), BuildOptions::best());
  ASSERT_TRUE(scene.parts().world.triangles.has_parts());
  EXPECT_GT(check_all(scene, mixed_rays(scene.bounds(), 3'000, 5), false), 300u);
}

TEST(KernelScene, CompactScenesTakeHalfTheMemory) {
  const SceneDesc desc = gallery::make("terrain:128");
  BuildOptions options = BuildOptions::balanced();
  const auto bytes_per_triangle = [&](bool is_compact) {
    options.is_compact = is_compact;
    const SceneStatistics statistics = Scene(desc, options).statistics();
    return double(statistics.tree_bytes + statistics.geometry_bytes) / double(statistics.primitives);
  };
  EXPECT_LT(bytes_per_triangle(false), 65);
  EXPECT_LT(bytes_per_triangle(true), 40);
}

TEST_P(KernelScenes, HoldValidTreesAndNothingTwice) {
  const Scene scene(gallery::make(GetParam()));
  const Part& world = scene.parts().world;
  EXPECT_EQ(simd::validate(world.triangles), "");
  std::size_t bytes = 0;
  const auto add = [&bytes](const Part& part) {
    bytes += part.triangles.size_bytes() + part.shape_bvh.size_bytes() +
             part.shapes.size() * sizeof(LeafShape) + part.meshes.size() * sizeof(PartMesh);
  };
  add(world);
  for (const Part& object : scene.parts().objects) add(object);
  bytes += scene.parts().top_level.size_bytes() + scene.parts().placements.size() * sizeof(Placement);
  const SceneStatistics statistics = scene.statistics();
  EXPECT_EQ(statistics.tree_bytes + statistics.geometry_bytes, bytes);
}

INSTANTIATE_TEST_SUITE_P(Gallery, KernelScenes,
                         ::testing::Values("stilllife", "spheres:2000", "soup:5000", "terrain:32", "cornell",
                                           "city:500", "duplicates:300"));

TEST(KernelScene, LeavesFillTheirBlocks) {
  const Scene scene(gallery::make("soup:5000"));
  const simd::TriangleTree& tree = scene.parts().world.triangles;
  EXPECT_GT(5000.0 / double(tree.block_count() * kBlockWidth), 0.8);
}

TriangleMesh scaled_soup(float scale) {
  Random random(6);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 500; ++i) {
    const Vec3 center = random.in_box(splat(-1), splat(1));
    for (int k = 0; k < 3; ++k) mesh.positions.push_back((center + random.direction() * 0.2f) * scale);
    mesh.indices.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TEST(KernelSizes, TinyAndHugeScenes) {
  for (const float scale : {1e-30f, 1e-20f, 1e-10f, 1.0f, 6e10f, 8e10f, 1e20f, 1e30f, 0x1p125f}) {
    SceneDesc desc;
    desc.add(scaled_soup(scale));
    const Scene scene(std::move(desc));
    std::vector<Ray> rays = mixed_rays(scene.bounds(), 500, 3);
    for (Ray& ray : rays) {  // a direction out of range is a miss: not what this test is about
      const float d = max_component(abs(ray.direction));
      if (d > 0 && std::isfinite(d) && (d < 0x1p-96f || d > 0x1p96f)) ray.direction = ray.direction / d;
    }
    EXPECT_GT(check_all(scene, rays, true), 50u) << scale;
  }
}

TEST(KernelSizes, MeshesOfVeryDifferentSizeInOneScene) {
  SceneDesc desc;
  for (const float scale : {1e-6f, 1.0f, 1e4f, 1e9f}) desc.add(scaled_soup(scale));
  const Scene scene(std::move(desc));
  EXPECT_GT(check_all(scene, mixed_rays({splat(-2), splat(2)}, 1000, 4), true), 100u);
  EXPECT_GT(check_all(scene, mixed_rays(scene.bounds(), 500, 5), true), 50u);
}

TEST(KernelSizes, OneTriangle) {
  SceneDesc desc;
  desc.add(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}});
  const Scene scene(std::move(desc));
  const Hit hit = scene.closest_hit({{0.25f, 0.5f, -2}, 0, {0, 0, 1}});
  EXPECT_EQ(hit.t, 2);
  EXPECT_EQ(hit.u, 0.25f);
  EXPECT_EQ(hit.v, 0.5f);
  EXPECT_EQ(hit.normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(hit.primitive_id, PrimId(0));
  EXPECT_GT(check_all(scene, mixed_rays({{0, 0, -1}, {1, 1, 1}}, 2000, 6), true), 100u);
}

TEST(KernelSizes, TiesGoToTheFirstOfManyMeshesInOnePlace) {
  // Each mesh is placed twice in the world, the last first.
  SceneDesc desc;
  const TriangleMesh square{{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
  for (int i = 0; i < 9; ++i) desc.add(square);
  for (int round = 0; round < 2; ++round)
    for (int i = 9; i-- > 0;)
      desc.add(Instance{GeometryId(static_cast<std::uint64_t>(i)), Affine3::identity(), {}});
  const Scene scene(std::move(desc));
  const Hit hit = scene.closest_hit({{0.3f, 1, 0.6f}, 0, {0, -1, 0}});
  EXPECT_EQ(hit.instance_id, InstanceId(0));
  EXPECT_EQ(hit.geometry_id, GeometryId(8));
  EXPECT_EQ(hit.primitive_id, PrimId(1));
  EXPECT_EQ(scene.count_hits({{0.3f, 1, 0.6f}, 0, {0, -1, 0}}), 18u);
  EXPECT_GT(check_all(scene, mixed_rays({{-1, -1, -1}, {1, 1, 1}}, 1000, 7), true), 100u);
}

/// One triangle `count` times: the first is hit, all are counted.
void check_copies(std::uint32_t count) {
  SceneDesc desc;
  desc.add(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                        std::vector<std::array<std::uint32_t, 3>>(count, {0, 1, 2}),
                        {},
                        {}});
  const Scene scene(std::move(desc));
  const Ray through{{0.25f, 0.25f, -1}, 0, {0, 0, 1}}, beside{{0.75f, 0.75f, -1}, 0, {0, 0, 1}};
  const Hit hit = scene.closest_hit(through);
  EXPECT_EQ(hit.t, 1);
  EXPECT_EQ(hit.primitive_id, PrimId(0));
  EXPECT_EQ(scene.count_hits(through), count);
  EXPECT_TRUE(scene.any_hit(through));
  EXPECT_FALSE(scene.any_hit(beside));
  const std::vector<Ray> rays{through, beside, through};
  std::vector<Hit> hits(3);
  scene.closest_hit(rays, hits);
  EXPECT_EQ(hits[0], hit);
  EXPECT_EQ(hits[1], Hit{});
  EXPECT_EQ(hits[2], hit);
}

TEST(KernelSizes, ManyCopiesOfOneTriangle) {
  check_copies(100'000);
  const char* is_long = std::getenv("BOXWOOD_LONG_TESTS");
  if (is_long && *is_long == '1') check_copies(1u << 24);
}

}  // namespace
}  // namespace boxwood
