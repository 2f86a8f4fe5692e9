// The surface at a hit, and the next ray, which never hits what it leaves.
#include "boxwood/scene/surface.h"

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/scene/parts.h"

namespace boxwood {
namespace {

/// Shoots at single primitives of one size and shape, far from the world's origin or near it, and lets every
/// hit send out rays to its own side. Returns how many of those hit the primitive again.
template <class MakeGeometry>
int self_hits(float scale, float offset, const Affine3& placed, const MakeGeometry& make, float& farthest) {
  Random random(5);
  int count = 0;
  farthest = 0;
  for (int i = 0; i < 2000; ++i) {
    SceneDesc desc;
    const Vec3 center = random.direction() * (offset * scale);
    desc.add({make(desc, random, center, scale), placed, {}});
    const Scene scene(desc);
    const Box3 box = scene.bounds();
    const Vec3 target = random.in_box(box.lower, box.upper);
    const Vec3 eye = target + random.direction() * (scale * random.uniform(0.01f, 10));
    const Ray ray{eye, 0, target - eye};
    const Hit hit = scene.closest_hit(ray);
    if (!hit.is_hit()) continue;
    const Surface surface = surface_at(scene, ray, hit);
    EXPECT_EQ(surface.normal, hit.normal);
    for (int k = 0; k < 20; ++k) {
      // Half of the rays leave at a grazing angle.
      Vec3 direction = random.direction();
      if (k % 2)
        direction = direction - surface.normal * (dot(direction, surface.normal) * random.uniform(0.999f, 1));
      const Ray next = surface.spawn(direction);
      const Hit again = scene.closest_hit(next);
      // Closed shapes are met again from inside, at their far side: only a hit at the start is a self-hit.
      if (again.is_hit() && length(direction) * again.t < 1e-4f * scale) ++count;
      farthest = max(farthest, length(next.origin - surface.position) / scale);
    }
  }
  return count;
}

GeometryId triangle(SceneDesc& desc, Random& random, Vec3 center, float scale) {
  TriangleMesh mesh;
  for (int k = 0; k < 3; ++k) mesh.positions.push_back(center + random.in_box(splat(-scale), splat(scale)));
  mesh.indices.push_back({0, 1, 2});
  return desc.add(mesh);
}

GeometryId sliver(SceneDesc& desc, Random& random, Vec3 center, float scale) {
  const Vec3 along = random.direction() * scale;
  TriangleMesh mesh;
  mesh.positions = {center, center + along, center + along * 0.4f + random.direction() * (scale * 0.003f)};
  mesh.indices.push_back({0, 1, 2});
  return desc.add(mesh);
}

GeometryId disk(SceneDesc& desc, Random& random, Vec3 center, float scale) {
  return desc.add(std::vector<Disk>{{center, random.direction(), scale}});
}

TEST(Surface, NextRayNeverHitsTheFlatPrimitiveItLeavesAtAnyScale) {
  const Affine3 turned =
      Affine3::translation({1, 2, 3}) * Affine3::rotation({1, 2, 3}, 40) * Affine3::scale({1, 2, 0.5f});
  for (const Affine3& placed : {Affine3::identity(), turned})
    for (const float scale : {1e-3f, 1.0f, 1e3f, 1e6f})
      for (const float offset : {0.0f, 10.0f, 1000.0f}) {
        float farthest;
        EXPECT_EQ(self_hits(scale, offset, placed, triangle, farthest), 0) << scale << " " << offset;
        EXPECT_EQ(self_hits(scale, offset, placed, sliver, farthest), 0) << scale << " " << offset;
        EXPECT_EQ(self_hits(scale, offset, placed, disk, farthest), 0) << scale << " " << offset;
      }
}

TEST(Surface, NextRayStartsCloseToTheSurface) {
  float farthest;
  self_hits(1, 0, Affine3::identity(), triangle, farthest);
  EXPECT_GT(farthest, 0);
  EXPECT_LT(farthest, 1e-4f);
}

TEST(Surface, NextRayLeavesASphereAndABlockToTheChosenSide) {
  Random random(9);
  for (const float scale : {1e-3f, 1.0f, 1e5f}) {
    SceneDesc desc;
    desc.add(std::vector<Sphere>{{splat(3 * scale), scale}});
    desc.add(std::vector<Cuboid>{{splat(-3 * scale), splat(-scale)}});
    const Scene scene(desc);
    for (int i = 0; i < 20000; ++i) {
      const Vec3 eye = random.direction() * (20 * scale);
      const Ray ray{eye, 0, random.in_box(splat(-3 * scale), splat(4 * scale)) - eye};
      const Hit hit = scene.closest_hit(ray);
      if (!hit.is_hit()) continue;
      const Surface surface = surface_at(scene, ray, hit);
      std::vector<Hit> hits;
      const Vec3 direction = random.direction();
      scene.all_hits(surface.spawn(direction), hits);
      std::erase_if(hits, [&](const Hit& h) { return h.geometry_id != hit.geometry_id; });
      // Outward: nothing of the convex solid again. Inward: out at the far side, once.
      ASSERT_EQ(hits.size(), dot(direction, hit.normal) < 0 ? 1u : 0u) << scale << " " << i;
    }
  }
}

TEST(Surface, InterpolatesWhatTheMeshGives) {
  SceneDesc desc;
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}};
  mesh.normals = {{0, 0, 1}, {1, 0, 1}, {0, 0, 1}};
  mesh.uvs = {{0, 0}, {2, 0}, {0, 4}};
  Material red;
  const MaterialId material = desc.add(red);
  desc.add(mesh, material);
  const Scene scene(desc);
  const Ray ray{{0.25f, 0.5f, 5}, 0, {0, 0, -1}};
  const Surface surface = surface_at(scene, ray, scene.closest_hit(ray));
  EXPECT_NEAR(surface.position.x, 0.25f, 1e-6f);
  EXPECT_NEAR(surface.uv.x, 0.5f, 1e-6f);
  EXPECT_NEAR(surface.uv.y, 2.0f, 1e-6f);
  EXPECT_EQ(surface.second_uv, surface.uv);
  EXPECT_GT(surface.shading_normal.x, 0.1f);
  EXPECT_EQ(surface.material, material);
}

TEST(Surface, HasTheSecondTextureCoordinatesOfTheMesh) {
  SceneDesc desc;
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {{0, 0}, {2, 0}, {0, 4}}};
  mesh.second_uvs = {{0, 0}, {0, 6}, {6, 0}};
  desc.add(mesh);
  const Scene scene(desc);
  const Ray ray{{0.25f, 0.5f, 5}, 0, {0, 0, -1}};
  const Hit hit = scene.closest_hit(ray);
  const Surface surface = surface_at(scene, ray, hit);
  EXPECT_NEAR(surface.uv.x, 0.5f, 1e-6f);
  EXPECT_NEAR(surface.second_uv.x, 3.0f, 1e-6f);
  EXPECT_NEAR(surface.second_uv.y, 1.5f, 1e-6f);
  EXPECT_FLOAT_EQ(uv_density(scene, hit), std::sqrt(8.0f));
  EXPECT_FLOAT_EQ(uv_density(scene, hit, true), 6);

  mesh.second_uvs.pop_back();
  SceneDesc uneven;
  uneven.add(mesh);
  EXPECT_THROW(check(uneven), std::invalid_argument);
}

}  // namespace
}  // namespace boxwood
