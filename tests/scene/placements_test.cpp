// Scenes of moved instances: kernels walk both levels and answer as a search without trees does, whatever the
// transforms. tests/CMakeLists.txt runs all of this with each set of kernels.
#include <cmath>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "scene/scene_checks.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

using test::check_all;
using test::mixed_rays;

TriangleMesh mesh_of(const test::Mesh& mesh) {
  return {mesh.positions, mesh.indices, {}, {}};
}

TriangleMesh square() {
  return {{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
}

/// From in, on and about one placement to another, beside rays of all kinds.
std::vector<Ray> rays_among_placements(const Scene& scene, std::size_t count, std::uint64_t seed) {
  std::vector<Ray> rays = mixed_rays(scene.bounds(), count, seed);
  const std::vector<Placement>& placements = scene.parts().placements;
  Random random(seed + 1);
  const auto point_in = [&](const Box3& box) { return random.in_box(box.lower, box.upper); };
  for (std::size_t i = 0; i < count; i += 2) {
    const Box3& from = placements[random.below(static_cast<std::uint32_t>(placements.size()))].world_box;
    const Box3& to = placements[random.below(static_cast<std::uint32_t>(placements.size()))].world_box;
    if (from.is_empty() || to.is_empty()) continue;
    Ray& ray = rays[i];
    ray = {point_in(from), 0, random.direction()};
    if (i % 3 > 0) ray.direction = point_in(to) - ray.origin;
    if (i % 3 == 2) ray.origin = ray.origin - ray.direction * 3;
    if (i % 5 == 0) ray.t_max = random.uniform();
    if (i % 7 == 0) ray.t_min = random.uniform() * 0.5f;
  }
  return rays;
}

/// Turned, mirrored, stretched, sheared and all but flat; some in one place.
std::vector<Affine3> hard_transforms() {
  const Affine3 turn = Affine3::rotation({1, 2, 3}, 33);
  Affine3 shear;
  shear.y = {0.7f, 1, -0.4f};
  std::vector<Affine3> out = {
      Affine3::translation({3, 0, 0}),
      Affine3::translation({3, 0, 0}),
      Affine3::translation({0, 3, 1}) * turn,
      Affine3::translation({-3, 0, 0}) * Affine3::scale({-1, 0.3f, 2}) * turn,
      Affine3::translation({0, -3, 0}) * Affine3::scale(-1),
      Affine3::translation({0, 0, 4}) * shear * turn,
      Affine3::translation({0, 0, -4}) * turn * Affine3::scale({1, 1, 1e-6f}),
      Affine3::translation({4, 4, 0}) * Affine3::scale({1e-3f, 1e3f, 1}) * turn,
      Affine3::translation({-4, 4, 0}) * Affine3::scale(1e-12f),
      Affine3::translation({1e6f, 0, 0}) * turn,
      Affine3::translation({1, 1, 1}) * Affine3::scale(0.5f),
      Affine3::translation({1, 1, 1}) * Affine3::scale(0.5f),
      Affine3::scale(7) * turn,
  };
  return out;
}

SceneDesc hard_scene(bool has_world, bool has_shapes) {
  SceneDesc desc;
  std::vector<GeometryId> ids = {desc.add(mesh_of(test::triangle_soup(60))), desc.add(TriangleMesh{}),
                                 desc.add(mesh_of(test::sponge(1))), desc.add(square())};
  if (has_shapes) {
    ids.push_back(desc.add(std::vector<Sphere>{{{0, 0, 0}, 0.5f}, {{1, 0, 0}, 0.25f}, {{0, 0, 0}, 0.5f}}));
    ids.push_back(desc.add(std::vector<Quad>{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}));
    ids.push_back(desc.add(std::vector<Sphere>{}));
  }
  for (const Affine3& transform : hard_transforms())
    for (const GeometryId id : ids) desc.add({id, transform, {}});
  if (has_world)
    for (const GeometryId id : ids) desc.add({id, Affine3::identity(), {}});
  return desc;
}

TEST(Placements, AnswerAsIfTheyHadNoTrees) {
  for (const bool has_world : {false, true})
    for (const bool has_shapes : {false, true}) {
      SCOPED_TRACE(testing::Message() << "world " << has_world << ", other shapes " << has_shapes);
      const Scene scene(hard_scene(has_world, has_shapes));
      EXPECT_GT(check_all(scene, rays_among_placements(scene, 3'000, 1), true), 500u);
    }
}

TEST(Placements, DoNotDependOnLayoutNorBuilder) {
  BuildOptions compact = BuildOptions::balanced(), textbook;
  compact.is_compact = true;
  textbook.method = Method::longest_axis;
  textbook.leaf_size = 1;
  const Scene scene(hard_scene(true, true));
  const std::vector<Ray> rays = rays_among_placements(scene, 3'000, 2);
  std::vector<Hit> expected(rays.size()), hits(rays.size());
  scene.closest_hit(rays, expected);
  for (const BuildOptions& options : {compact, textbook, BuildOptions::best(), BuildOptions::fast()}) {
    const Scene other(hard_scene(true, true), options);
    other.closest_hit(rays, hits);
    EXPECT_EQ(hits, expected);
    EXPECT_GT(check_all(other, rays, false), 500u);
  }
}

TEST(Placements, OfOneMeshMayBeOneOrTenThousand) {
  Random random(3);
  for (const int count : {1, 2, 9, 10'000}) {
    SceneDesc desc;
    const GeometryId ids[] = {desc.add(mesh_of(test::icosphere(2))), desc.add(square())};
    for (int i = 0; i < count; ++i)
      desc.add({ids[i % 2],
                Affine3::translation(random.in_box(splat(-20), splat(20))) *
                    Affine3::rotation(random.direction(), 360 * random.uniform()) *
                    Affine3::scale(0.2f + random.uniform()),
                {}});
    const Scene scene(std::move(desc));
    EXPECT_GT(check_all(scene, rays_among_placements(scene, 2'000, 4), count < 10), 400u) << count;
  }
}

// Where t is the same to the last bit, the smallest instance is hit: in any order of the placements, and of
// triangles in the world.
TEST(Placements, TiesGoToTheFirstInstance) {
  for (int first_in_world = 0; first_in_world < 2; ++first_in_world) {
    SceneDesc desc;
    TriangleMesh moved = square();
    for (Vec3& p : moved.positions) p = p + Vec3{2, 4, 0};
    const GeometryId here = desc.add(moved), there = desc.add(square()), again = desc.add(square());
    const Affine3 up = Affine3::translation({2, 4, 0});
    if (first_in_world) desc.add({here, Affine3::identity(), {}});
    for (int i = 0; i < 20; ++i) desc.add({i % 3 ? there : again, up, {}});
    desc.add({here, Affine3::identity(), {}});
    const Scene scene(std::move(desc));
    const Ray down{{2.25f, 8, 0.5f}, 0, {0, -1, 0}};
    const Hit hit = scene.closest_hit(down);
    EXPECT_EQ(hit.t, 4);
    EXPECT_EQ(hit.instance_id, InstanceId(0));
    EXPECT_EQ(hit.geometry_id, first_in_world ? here : again);
    EXPECT_EQ(scene.count_hits(down), 21u + static_cast<unsigned>(first_in_world));
    // A limit at that very t counts.
    Ray limited = down;
    limited.t_max = 4;
    EXPECT_EQ(scene.closest_hit(limited), hit);
    EXPECT_TRUE(scene.any_hit(limited));
    std::vector<Ray> rays = mixed_rays(scene.bounds(), 1'000, 5);
    rays.push_back(down);
    rays.push_back(limited);
    EXPECT_GT(check_all(scene, rays, true), 100u);
  }
}

// Some rays are ordinary in the world and not in an object's space, and some objects are not ordinary at all.
TEST(Placements, OfAnySize) {
  for (const auto& [size, scale] : {std::pair{0x1p-20f, 0x1p40f},
                                    {0x1p-40f, 0x1p45f},
                                    {0x1p40f, 0x1p-40f},
                                    {1.0f, 0x1p40f},
                                    {1.0f, 0x1p60f},
                                    {0x1p-60f, 1.0f},
                                    {0x1p30f, 0x1p-60f}}) {
    SCOPED_TRACE(testing::Message() << size << " times " << scale);
    TriangleMesh large = mesh_of(test::triangle_soup(60));
    for (Vec3& p : large.positions) p = p * size;
    SceneDesc desc;
    const GeometryId ids[] = {desc.add(large), desc.add(mesh_of(test::sponge(1)))};
    for (int i = 0; i < 3; ++i)
      desc.add({ids[0],
                Affine3::translation(splat(float(i))) * Affine3::rotation({1, 2, float(i)}, 50) *
                    Affine3::scale(scale),
                {}});
    desc.add({ids[1], Affine3::translation({1, 2, 3}), {}});
    const Scene scene(std::move(desc));
    EXPECT_GT(check_all(scene, rays_among_placements(scene, 1'000, 6), true), 50u);
  }
}

TEST(Placements, OfNothingLeaveTheKernelsToTheWorld) {
  SceneDesc desc;
  desc.add(Instance{desc.add(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}})});
  desc.add(Instance{desc.add(TriangleMesh{}), Affine3::translation({1, 2, 3})});
  desc.add(Instance{desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}}), Affine3::translation({1e12f, 0, 0})});
  const Scene scene(std::move(desc));
  EXPECT_EQ(scene.parts().kernels, simd::kernels());
}

TEST(Placements, OfNothing) {
  SceneDesc desc;
  const GeometryId empty = desc.add(TriangleMesh{}), none = desc.add(std::vector<Sphere>{});
  for (int i = 0; i < 20; ++i) desc.add({i % 2 ? empty : none, Affine3::translation({1, 2, 3}), {}});
  const Scene scene(std::move(desc));
  EXPECT_EQ(check_all(scene, mixed_rays({splat(-1), splat(1)}, 500, 8), true), 0u);
}

}  // namespace
}  // namespace boxwood
