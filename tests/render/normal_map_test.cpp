// Normal maps: which way do they bend a surface, and its coat?
#include <gtest/gtest.h>

#include "boxwood/render/uv_frame.h"
#include "trace.h"

namespace boxwood::render {
namespace {

/// A picture of one texel that bends normals by half a right angle, towards where u grows.
Texture toward_u() {
  Texture texture;
  texture.width = texture.height = 1;
  texture.texels = {{218, 128, 218, 255}};
  texture.is_srgb = false;
  return texture;
}

/// A square in z = 0 that faces +z; u grows along x, v along y. In the second set u grows along y, v along x.
TriangleMesh square() {
  TriangleMesh mesh{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
  for (const Vec3 p : mesh.positions) {
    mesh.uvs.push_back({p.x, p.y});
    mesh.second_uvs.push_back({p.y, p.x});
  }
  return mesh;
}

Vec3 mapped(const Texture& map, float scale = 1) {
  SceneDesc desc;
  const TextureId id = desc.add(map);
  desc.add(square());
  const Scene scene(std::move(desc));
  const Ray ray{{0.1f, 0.2f, 1}, 0, {0, 0, -1}};
  const Hit hit = scene.closest_hit(ray);
  return mapped_normal(scene, hit, surface_at(scene, ray, hit), id, scale);
}

void expect_direction(Vec3 found, Vec3 expected) {
  EXPECT_LT(length(found - normalize(expected)), 0.01f) << found.x << " " << found.y << " " << found.z;
}

TEST(NormalMap, BendsAlongThePicturesOwnDirections) {
  Texture map = toward_u();
  expect_direction(mapped(map), {1, 0, 1});
  expect_direction(mapped(map, 0.5f), {0.5f, 0, 1});
  map.is_by_second_uvs = true;
  expect_direction(mapped(map), {0, 1, 1});

  // A picture that lies turned by a right angle: its u grows where v of the surface falls.
  map.is_by_second_uvs = false;
  map.u_axis = {0, 1};
  map.v_axis = {-1, 0};
  expect_direction(mapped(map), {0, -1, 1});
  // And mirrored, as a scale of -1 does.
  map.u_axis = {-1, 0};
  map.v_axis = {0, 1};
  expect_direction(mapped(map), {-1, 0, 1});
}

/// The normal of a square whose heights grow from 0 to `height` between u = -1/4 and 1/4, mirrored or not.
Vec3 bumped(float height, bool is_mirrored) {
  SceneDesc desc;
  Texture steps;
  steps.width = 2;
  steps.height = 1;
  steps.texels = {{255, 255, 255, 255}, {0, 0, 0, 255}};
  steps.is_srgb = false;
  const TextureId id = desc.add(steps);
  TriangleMesh mesh = square();
  if (is_mirrored)
    for (Vec2& uv : mesh.uvs) uv.x = -uv.x;
  desc.add(std::move(mesh));
  const Scene scene(std::move(desc));
  const Ray ray{{0, 0.2f, 1}, 0, {0, 0, -1}};
  const Hit hit = scene.closest_hit(ray);
  const Surface surface = surface_at(scene, ray, hit);
  return bumped_normal(scene, hit, surface, surface.shading_normal, height, {id, {}});
}

TEST(NormalMap, BumpsLeanAwayFromWhereTheyRise) {
  expect_direction(bumped(0.5f, false), {-1, 0, 1});
  expect_direction(bumped(-0.25f, false), {0.5f, 0, 1});
  expect_direction(bumped(0.5f, true), {1, 0, 1});
  expect_direction(bumped(0, false), {0, 0, 1});
}

TEST(NormalMap, BumpsShowInThePicture) {
  // A slope that leans away from a lamp at the horizon gets less of it.
  const auto seen = [](float height) {
    SceneDesc desc;
    Texture steps;
    steps.width = 2;
    steps.height = 1;
    steps.texels = {{255, 255, 255, 255}, {0, 0, 0, 255}};
    const TextureId id = desc.add(steps);
    Material matte;
    matte.bump = height;
    matte.bump_texture = {id, {}};
    desc.add(square(), desc.add(matte));
    desc.distant_lights.push_back({normalize(Vec3{-1, 0, -1}), splat(1)});
    const Scene scene(std::move(desc));
    return mean_radiance(scene, Ray{{0, 0.2f, 1}, 0, {0, 0, -1}}, 16).x;
  };
  const float level = seen(0);
  EXPECT_GT(level, 0.1f);
  EXPECT_LT(seen(0.25f), 0.6f * level);
  EXPECT_GT(seen(-0.25f), 1.1f * level);
}

/// What is seen of a black square under a smooth coat, from above. The coat reflects 4% of a lamp of radiance
/// 1, where it lies so that the light comes this way. The map bends by half of its slopes.
float seen_of_coat(const Material& black, Vec3 lamp_at) {
  SceneDesc desc;
  const TextureId map = desc.add(toward_u());
  Material coated = black;
  coated.kind = Material::Kind::layered;
  coated.color = {0, 0, 0};
  coated.specular = 0;
  coated.coat = 1;
  coated.normal_scale = coated.coat_normal_scale = 0.5f;
  if (black.normal_texture.is_valid()) coated.normal_texture = map;
  if (black.coat_normal_texture.is_valid()) coated.coat_normal_texture = map;
  desc.add(square(), desc.add(coated));
  desc.add(std::vector<Sphere>{{lamp_at, 2}}, desc.add(lamp(1)));
  const Scene scene(std::move(desc));
  return mean_radiance(scene, Ray{{0.1f, 0.2f, 1}, 0, {0, 0, -1}}, 256).x;
}

TEST(NormalMap, ACoatHasItsOwn) {
  const Vec3 above{0, 0, 10}, beside{8, 0, 6};
  Material material;
  EXPECT_NEAR(seen_of_coat(material, above), 0.04f, 1e-3f);
  EXPECT_EQ(seen_of_coat(material, beside), 0);

  // That of the surface below does not bend the coat.
  material.normal_texture = TextureId(0);
  EXPECT_NEAR(seen_of_coat(material, above), 0.04f, 1e-3f);
  EXPECT_EQ(seen_of_coat(material, beside), 0);

  material.coat_normal_texture = TextureId(0);
  EXPECT_EQ(seen_of_coat(material, above), 0);
  EXPECT_NEAR(seen_of_coat(material, beside), 0.041f, 1e-3f);
  material.normal_texture = {};
  EXPECT_EQ(seen_of_coat(material, above), 0);
  EXPECT_NEAR(seen_of_coat(material, beside), 0.041f, 1e-3f);
}

}  // namespace
}  // namespace boxwood::render
