// path_lamps_test.cpp: does the light of lamps of every kind arrive as closed forms say?
#include <gtest/gtest.h>

#include "boxwood/render/light.h"
#include "boxwood/render/path.h"
#include "boxwood/render/warp.h"
#include "trace.h"

namespace boxwood::render {
namespace {

using Kind = Material::Kind;

TEST(Path, UnderADisk) {
  // A disk of radius r at height h over the point: E = pi L r^2 / (r^2 + h^2).
  for (const float radius : {0.1f, 1.0f, 5.0f}) {
    const float found = floor_radiance(
        [&](SceneDesc& desc) {
          desc.add(std::vector<Disk>{{{0, 2, 0}, {0, -3, 0}, radius}}, desc.add(lamp(10)));
        },
        1 << 13);
    const float expected = lambert(kPi * 10 * radius * radius / (radius * radius + 4));
    EXPECT_NEAR(found / expected, 1, 0.01f) << radius;
  }
}

TEST(Path, UnderASquareOfTriangles) {
  // The form factor of a rectangle whose corner is over the point, four times (Howell, Catalog of
  // Configuration Factors, B-3).
  const float half = 0.8f, height = 1.5f, x = half / height;
  const float quarter = 2 * x / std::sqrt(1 + x * x) * std::atan(x / std::sqrt(1 + x * x)) / (2 * kPi);
  const float expected = lambert(kPi * 10 * 4 * quarter);
  const float found = floor_radiance(
      [&](SceneDesc& desc) {
        // In object space twice as small and standing elsewhere, so that the transform matters.
        TriangleMesh mesh{{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
        const GeometryId square = desc.add(std::move(mesh), desc.add(lamp(10)));
        desc.add(Instance{GeometryId(0), Affine3::identity(), {}});
        desc.add(Instance{square, Affine3::translation({0, height, 0}) * Affine3::scale(half), {}});
      },
      1 << 13);
  EXPECT_NEAR(found / expected, 1, 0.01f);
}

TEST(Path, UnderASphere) {
  // All of a sphere above the horizon: E = pi L (r / d)^2, for any size; also when it is an instance.
  for (const float radius : {0.05f, 0.5f, 1.9f}) {
    const float expected = lambert(kPi * 10 * radius * radius / 4);
    const float plain = floor_radiance(
        [&](SceneDesc& desc) {
          desc.add(std::vector<Sphere>{{{0, 2, 0}, radius}}, desc.add(lamp(10)));
        },
        1 << 13, {2.5f, 0.5f, 0});
    EXPECT_NEAR(plain / expected, 1, 0.01f) << radius;
    const float placed = floor_radiance(
        [&](SceneDesc& desc) {
          const GeometryId ball = desc.add(std::vector<Sphere>{{{1, 1, 1}, 0.5f}}, desc.add(lamp(10)));
          desc.add(Instance{GeometryId(0), Affine3::identity(), {}});
          desc.add(Instance{ball,
                            Affine3::translation({0, 2, 0}) * Affine3::scale(2 * radius) *
                                Affine3::translation({-1, -1, -1}),
                            {}});
        },
        1 << 13, {2.5f, 0.5f, 0});
    EXPECT_NEAR(placed / expected, 1, 0.01f) << radius;
  }
}

TEST(Path, ASquashedSphereIsAnEllipsoidOfLight) {
  // Squashed flat, a sphere of radius 1 shines like a disk of radius 1.
  const float found = floor_radiance(
      [&](SceneDesc& desc) {
        const GeometryId ball = desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}}, desc.add(lamp(10)));
        desc.add(Instance{GeometryId(0), Affine3::identity(), {}});
        desc.add(Instance{ball, Affine3::translation({0, 2, 0}) * Affine3::scale({1, 0.001f, 1}), {}});
      },
      1 << 14);
  EXPECT_NEAR(found / lambert(kPi * 10 / 5), 1, 0.02f);
}

TEST(Path, UnderABlock) {
  // Only the lower face of a block that is wide and high up matters: a rectangle again.
  const float half = 0.8f, height = 1.5f, x = half / height;
  const float quarter = 2 * x / std::sqrt(1 + x * x) * std::atan(x / std::sqrt(1 + x * x)) / (2 * kPi);
  const float found = floor_radiance(
      [&](SceneDesc& desc) {
        desc.add(std::vector<Cuboid>{{{-half, height, -half}, {half, height + 0.5f, half}}},
                 desc.add(lamp(10)));
      },
      1 << 13);
  EXPECT_NEAR(found / lambert(kPi * 10 * 4 * quarter), 1, 0.01f);
}

TEST(Path, LampsShineFromTheirFrontUnlessToldOtherwise) {
  const auto disk_facing_up = [](bool both) {
    return floor_radiance(
        [&](SceneDesc& desc) {
          desc.add(std::vector<Disk>{{{0, 2, 0}, {0, 1, 0}, 1}}, desc.add(lamp(10, both)));
        },
        1 << 12);
  };
  EXPECT_EQ(disk_facing_up(false), 0);
  EXPECT_NEAR(disk_facing_up(true) / lambert(kPi * 10 / 5), 1, 0.02f);
}

TEST(Path, PointAndDistantLightAndSun) {
  EXPECT_NEAR(floor_radiance(
                  [](SceneDesc& desc) {
                    desc.point_lights.push_back({{0, 4, 3}, splat(100)});
                  },
                  64) /
                  lambert(100.0f / 25 * 0.8f),
              1, 1e-4f);
  EXPECT_NEAR(floor_radiance(
                  [](SceneDesc& desc) {
                    desc.distant_lights.push_back({{0.6f, -0.8f, 0}, splat(3)});
                  },
                  64) /
                  lambert(3 * 0.8f),
              1, 1e-4f);
  for (const float angle : {0.53f, 20.0f}) {
    const float half = angle * 0.5f * kPi / 180;
    const float found = floor_radiance(
        [&](SceneDesc& desc) {
          desc.sky = constant_sky(0);
          desc.sky->sun_direction = {0.6f, 0.8f, 0};
          desc.sky->sun_angle_deg = angle;
          desc.sky->sun_radiance = splat(1000);
        },
        1 << 12);
    // A uniform disk of directions: E = pi L sin^2(half) cos.
    EXPECT_NEAR(found / lambert(kPi * 1000 * std::sin(half) * std::sin(half) * 0.8f), 1, 0.005f) << angle;
  }
}

TEST(Path, ManyLightsOfAllKindsAddUp) {
  // More than are weighed one by one, and fewer: the sum of the closed forms either way.
  for (const int lamps : {3, 100}) {
    float expected = 0;
    const float found = floor_radiance(
        [&](SceneDesc& desc) {
          const MaterialId material = desc.add(lamp(10));
          for (int i = 0; i < lamps; ++i) {
            const float angle = static_cast<float>(i), height = 1 + 0.01f * static_cast<float>(i);
            const Vec3 center{3 * std::cos(angle), height, 3 * std::sin(angle)};
            desc.add(std::vector<Sphere>{{center, 0.2f}}, material);
            expected += kPi * 10 * 0.04f / length_squared(center) * (height / length(center));
          }
          desc.point_lights.push_back({{0, 4, 3}, splat(100)});
          desc.distant_lights.push_back({{0, -1, 0}, splat(2)});
          expected += 100.0f / 25 * 0.8f + 2;
        },
        1 << 15, {0, 0.5f, 0.001f});
    EXPECT_NEAR(found / lambert(expected), 1, 0.02f) << lamps;
  }
}

TEST(Path, RoughMetalSeesALampByBothWaysOfLooking) {
  // The weights of the two estimators sum to one: a mirror-like and a rough floor under a sky-wide lamp look
  // as bright as it.
  for (const float roughness : {0.02f, 0.2f, 0.6f}) {
    SceneDesc desc;
    desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}},
             desc.add(material_of_kind(Kind::metal, splat(1), roughness)));
    desc.add(std::vector<Sphere>{{{0, 0, 0}, 50}}, desc.add(lamp(2, true)));
    const Scene lamp_scene(std::move(desc));
    SceneDesc sky_desc;
    sky_desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}},
                 sky_desc.add(material_of_kind(Kind::metal, splat(1), roughness)));
    sky_desc.sky = constant_sky(2);
    const Scene sky_scene(std::move(sky_desc));
    const Ray ray{{0.4f, 0, 5}, 0, {0, 0, -1}};
    EXPECT_NEAR(mean_radiance(lamp_scene, ray, 1 << 15).x, mean_radiance(sky_scene, ray, 1 << 13).x, 0.02f)
        << roughness;
  }
}

TEST(Path, ASceneWithoutLightIsShownUnderThePlainSky) {
  SceneDesc desc;
  desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}});
  const Scene scene(desc);
  const Vec3 lit = mean_radiance(scene, Ray{{0, 0, 5}, 0, {0, 0, -1}}, 64);
  EXPECT_GT(min_component(lit), 0.1f);
  EXPECT_LT(max_component(lit), 1.0f);

  EXPECT_FALSE(has_light(desc));
  SceneDesc glowing = desc;
  glowing.materials.push_back({.emission = splat(1)});
  EXPECT_TRUE(has_light(glowing));
  glowing.is_lit_by_glow = false;  // a model with a detail that glows
  EXPECT_FALSE(has_light(glowing));
  desc.point_lights.push_back({{0, 100, 0}, splat(1)});
  EXPECT_TRUE(has_light(desc));
  const Scene dark(desc);
  EXPECT_EQ(mean_radiance(dark, Ray{{0, 0, 5}, 0, {1, 0, 0}}, 4), Vec3{});
}

}  // namespace
}  // namespace boxwood::render
