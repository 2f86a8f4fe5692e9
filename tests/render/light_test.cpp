// Lights: the tree over many of them, and pictures of the surroundings.
#include "boxwood/render/light.h"

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/render/environment.h"
#include "boxwood/render/light_tree.h"
#include "boxwood/render/warp.h"
#include "trace.h"

namespace boxwood::render {
namespace {

std::vector<LightBounds> random_lights(int count) {
  Random random(4);
  std::vector<LightBounds> lights(count);
  for (LightBounds& light : lights) {
    const Vec3 at = random.direction() * (10 * random.uniform());
    light.box.extend(at);
    light.box.extend(at + random.direction() * random.uniform());
    light.axis = random.direction();
    light.cos_facing = 1 - 2 * random.uniform() * random.uniform();
    light.cos_spread = random.uniform() < 0.3f ? 0.7f : 0;
    light.strength = random.uniform() < 0.1f ? 0 : random.uniform() * 10;
    light.is_two_sided = random.uniform() < 0.2f;
  }
  return lights;
}

TEST(LightTree, ProbabilitiesAreThoseOfTheChoicesAndSumToOne) {
  for (const int count : {1, 2, 3, 17, 300}) {
    const std::vector<LightBounds> lights = random_lights(count);
    const LightTree tree(lights);
    Random random(9);
    for (int trial = 0; trial < 20; ++trial) {
      const Receiver from{random.direction() * 8.0f, trial % 3 == 0 ? Vec3{0, 0, 0} : random.direction()};
      double sum = 0;
      for (std::uint32_t i = 0; i < lights.size(); ++i) sum += tree.probability(i, from);
      // Where a branch of the tree turns out to hold nothing, its share is lost.
      EXPECT_LE(sum, 1.0001);
      for (int s = 0; s < 50; ++s) {
        float choice = random.uniform();
        const auto chosen = tree.choose(from, choice);
        if (!chosen) continue;
        EXPECT_GE(choice, 0);
        EXPECT_LT(choice, 1);
        EXPECT_GT(lights[chosen->light].strength, 0);
        EXPECT_NEAR(chosen->probability / tree.probability(chosen->light, from), 1, 1e-4f);
      }
    }
  }
}

TEST(LightTree, ALightThatReachesThePointIsNeverOutOfReachOfTheChoice) {
  const std::vector<LightBounds> lights = random_lights(200);
  const LightTree tree(lights);
  Random random(5);
  int checked = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const auto which = std::min(static_cast<std::uint32_t>(random.uniform() * 200), 199u);
    const LightBounds& light = lights[which];
    if (!(light.strength > 0)) continue;
    // A point of the light, a way in which it shines, and a surface on that way that faces it.
    const Vec3 e = light.box.extent();
    const Vec3 at =
        light.box.lower + Vec3{e.x * random.uniform(), e.y * random.uniform(), e.z * random.uniform()};
    const Vec3 way = random.direction();
    const float angle = std::acos(min(max(dot(way, light.axis), -1.0f), 1.0f));
    const float reach = std::acos(light.cos_facing) + std::acos(light.cos_spread) - 0.01f;
    if (!(angle < reach) && !(light.is_two_sided && kPi - angle < reach)) continue;
    const Receiver from{at + way * (5 * random.uniform() + 0.01f), random.direction()};
    if (!(dot(from.normal, -way) > 0.01f)) continue;
    EXPECT_GT(tree.probability(which, from), 0);
    ++checked;
  }
  EXPECT_GT(checked, 2000);
}

TEST(LightTree, ChoosesByHowOftenItSays) {
  const std::vector<LightBounds> lights = random_lights(30);
  const LightTree tree(lights);
  const Receiver from{{1, 2, 3}, {0, 0, 0}};
  std::vector<int> found(lights.size());
  constexpr int kCount = 200000;
  Random random(1);
  for (int s = 0; s < kCount; ++s) {
    float choice = random.uniform();
    if (const auto chosen = tree.choose(from, choice)) ++found[chosen->light];
  }
  for (std::uint32_t i = 0; i < lights.size(); ++i)
    EXPECT_NEAR(found[i] / double(kCount), tree.probability(i, from), 0.005) << i;
}

/// Dark, with a bright spot and a bright band.
Environment spotted() {
  Environment environment;
  environment.radiance = Image(32, 16, 3);
  for (float& value : environment.radiance.pixels) value = 0.05f;
  for (int c = 0; c < 3; ++c) environment.radiance.at(20, 5)[c] = 300;
  for (int x = 0; x < 32; ++x) environment.radiance.at(x, 12)[1] = 4;
  environment.world_from_environment = Affine3::rotation({1, 2, 3}, 40);
  return environment;
}

TEST(EnvironmentLight, DensityIntegratesToOneAndSamplesFollowIt) {
  const Environment environment = spotted();
  const EnvironmentLight light(environment);
  double whole = 0, radiance = 0;
  constexpr int kSteps = 1000;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const Vec3 direction =
          uniform_cone({(static_cast<float>(i) + 0.5f) / kSteps, (static_cast<float>(j) + 0.5f) / kSteps}, 2);
      whole += light.pdf(direction) * 4 * kPi / (double(kSteps) * kSteps);
      radiance += light.radiance(direction).y * 4 * kPi / (double(kSteps) * kSteps);
    }
  EXPECT_NEAR(whole, 1, 0.003);

  // The mean of radiance over density is the integral of the radiance; and each density is its own.
  double sum = 0;
  constexpr int kCount = 1 << 15;
  for (std::uint32_t s = 0; s < kCount; ++s) {
    Sampler sampler(2, s);
    const auto sample = light.sample(sampler.next_2d());
    ASSERT_GT(sample.pdf, 0);
    EXPECT_NEAR(length(sample.direction), 1, 1e-5f);
    if (s % 64 == 0) {
      EXPECT_NEAR(light.pdf(sample.direction) / sample.pdf, 1, 0.05) << s;
    }
    sum += light.radiance(sample.direction).y / sample.pdf;
  }
  EXPECT_NEAR(sum / kCount / radiance, 1, 0.01);
}

TEST(EnvironmentLight, LooksWhereThePictureSays) {
  Environment environment;
  environment.radiance = Image(4, 2, 3);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x) environment.radiance.at(x, y)[0] = static_cast<float>(1 + x + 4 * y);
  const EnvironmentLight light(environment);
  const auto at = [&](float longitude_deg, float z) {
    const float angle = longitude_deg * kPi / 180, r = std::sqrt(1 - z * z);
    return light.radiance({r * std::cos(angle), r * std::sin(angle), z}).x;
  };
  const float half = std::sqrt(0.5f);
  EXPECT_NEAR(at(45, half), 1, 1e-4f);
  EXPECT_NEAR(at(135, half), 2, 1e-4f);
  EXPECT_NEAR(at(315, half), 4, 1e-4f);
  EXPECT_NEAR(at(225, -half), 7, 1e-4f);
}

TEST(EnvironmentLight, PixelsThatAreNoLightAreBlack) {
  Environment environment;
  environment.radiance = Image(8, 4, 3);
  for (float& value : environment.radiance.pixels) value = 1;
  environment.radiance.at(3, 2)[0] = std::nanf("");
  environment.radiance.at(4, 1)[1] = -5;
  environment.radiance.at(5, 1)[2] = kInfinity;
  const EnvironmentLight light(environment);
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 radiance = light.radiance(random.direction());
    EXPECT_TRUE(is_finite(radiance) && min_component(radiance) >= 0 && max_component(radiance) <= 1.00001f);
    EXPECT_TRUE(std::isfinite(light.sample({random.uniform(), random.uniform()}).pdf));
  }
  // No light at all: nothing to sample.
  for (float& value : environment.radiance.pixels) value = 0;
  EXPECT_EQ(EnvironmentLight(environment).sample({0.3f, 0.7f}).pdf, 0);
}

TEST(Path, ASphereInAnEnvironmentIsTheIntegralOverItsHemisphere) {
  // The radiance of a matte point: the quadrature of light times cosine, over a fine grid.
  const Environment environment = spotted();
  const EnvironmentLight light(environment);
  SceneDesc desc;
  desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}},
           desc.add(material_of_kind(Material::Kind::matte, splat(0.5f))));
  desc.environments.push_back(environment);
  const Scene scene(std::move(desc));
  for (const Vec3 from : {Vec3{0, 0, 5}, Vec3{0, 5, 0}, Vec3{-5, 0, 0}}) {
    const Vec3 normal = normalize(from);
    const Frame frame(normal);
    double expected = 0;
    constexpr int kSteps = 1500;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const Vec3 local = cosine_hemisphere(
            {(static_cast<float>(i) + 0.5f) / kSteps, (static_cast<float>(j) + 0.5f) / kSteps});
        expected += light.radiance(frame.to_world(local)).y / (double(kSteps) * kSteps);
      }
    const Vec3 found = mean_radiance(scene, Ray{from, 0, -normal}, 1 << 14);
    EXPECT_NEAR(found.y / (0.5 * expected), 1, 0.01) << from.x << from.y << from.z;
  }
}

TEST(Path, LampsWithPicturesMayLieInTheSecondCoordinates) {
  // The same lamp, half of it dark, its picture by the first set of coordinates or by the second.
  const auto floor_under = [](bool by_second, bool is_swapped) {
    return floor_radiance(
        [&](SceneDesc& desc) {
          Texture half;
          half.width = 2;
          half.height = 1;
          half.texels = {{255, 255, 255, 255}, {0, 0, 0, 255}};
          half.is_by_second_uvs = by_second;
          Material shining = lamp(1);
          shining.emission_texture = desc.add(half);
          TriangleMesh mesh{{{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
          const std::vector<Vec2> lies{{0, 0}, {1, 0}, {1, 1}, {0, 1}},
              turned{{1, 0}, {0, 0}, {0, 1}, {1, 1}};
          mesh.uvs = is_swapped ? turned : lies;
          mesh.second_uvs = is_swapped ? lies : turned;
          desc.add(std::move(mesh), desc.add(shining));
        },
        2048);
  };
  const float near_half = floor_under(false, false), far_half = floor_under(false, true);
  EXPECT_GT(near_half, 1.2f * far_half);
  EXPECT_EQ(floor_under(true, true), near_half);
  EXPECT_EQ(floor_under(true, false), far_half);
}

TEST(Path, SpotLightsShineInTheirConeOnly) {
  // A floor under a spot that looks straight down: full light inside, none outside, and the smoothstep
  // between.
  const auto floor_at = [](float x) {
    SceneDesc desc;
    const MaterialId matte = desc.add(material_of_kind(Material::Kind::matte, splat(0.5f)));
    desc.add(std::vector<Quad>{{{-50, 0, -50}, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}}}, matte);
    SpotLight spot;
    spot.position = {0, 2, 0};
    spot.direction = {0, -1, 0};
    spot.intensity = splat(10);
    spot.inner_cosine = std::cos(0.5f);
    spot.outer_cosine = std::cos(0.7f);
    desc.spot_lights.push_back(spot);
    const Scene scene(std::move(desc));
    return mean_radiance(scene, Ray{{x, 1, 0}, 0, {0, -1, 0}}, 16).x;
  };
  const auto expected = [](float x, float share) {
    const float distance_squared = x * x + 4;
    return 0.5f / kPi * 10 * share / distance_squared * (2 / std::sqrt(distance_squared));
  };
  EXPECT_NEAR(floor_at(0.5f) / expected(0.5f, 1), 1, 1e-4f);
  EXPECT_EQ(floor_at(2 * std::tan(0.71f)), 0);
  const float x = 2 * std::tan(0.6f),
              t = (std::cos(0.6f) - std::cos(0.7f)) / (std::cos(0.5f) - std::cos(0.7f));
  EXPECT_NEAR(floor_at(x) / expected(x, t * t * (3 - 2 * t)), 1, 1e-3f);
}

TEST(Lights, DensityOfAHitIsThatOfTheSample) {
  // For every kind of emitter: sample a point, trace to it, and ask for the density of what was hit.
  SceneDesc desc;
  const MaterialId material = desc.add(lamp(3, true));
  const MaterialId dull = desc.add(Material{});
  desc.add(std::vector<Sphere>{{{-4, 3, 0}, 0.7f}, {{-4, 5, 1}, 0.2f}}, material);
  desc.add(std::vector<Disk>{{{4, 3, 0}, {1, -1, 0.2f}, 0.7f}}, material);
  desc.add(std::vector<Quad>{{{0, 3, 4}, {1, 3, 4}, {1.2f, 3.5f, 5}, {0, 3, 5}}}, material);
  desc.add(std::vector<Cuboid>{{{0, 3, -4}, {1, 4, -3}}}, material);
  Geometry mixed{
      TriangleMesh{{{0, 5, 0}, {1, 5, 0}, {0, 5, 1}, {1, 6, 1}}, {{0, 1, 2}, {1, 2, 3}, {0, 2, 3}}, {}, {}},
      {},
      {dull, material, material},
      ""};
  desc.add(std::move(mixed));
  desc.instances = placed_instances(desc);
  for (Instance& instance : desc.instances)
    instance.world_from_object = Affine3::translation({0.1f, 0.2f, 0.3f}) * Affine3::rotation({1, 2, 3}, 20) *
                                 Affine3::scale({1, 1.3f, 0.8f});
  const Scene scene(desc);
  const Lights lights(scene, Camera{});

  Surface surface{};
  surface.normal = surface.shading_normal = {0, 1, 0};
  std::array<int, 5> found{};
  for (std::uint32_t s = 0; s < 2000; ++s) {
    Sampler sampler(3, s);
    const float choice = sampler.next_1d();
    const auto sample = lights.sample(surface, surface.normal, choice, sampler.next_2d());
    if (!sample) continue;
    // The shadow ray ends just before the light; drawn out a little, it hits it.
    Ray ray{surface.position, 0, sample->direction};
    const Hit hit = scene.closest_hit(ray);
    if (!hit || std::fabs(hit.t - length(sample->shadow_ray.direction)) > 5e-5f)
      continue;  // something is in the way
    const float pdf =
        lights.pdf(hit, surface_at(scene, ray, hit), sample->direction, {surface.position, surface.normal});
    const float cosine = std::fabs(dot(hit.normal, sample->direction));
    // Seen edge-on the density grows as 1 / cosine, of which rounding leaves four digits.
    EXPECT_NEAR(pdf / sample->pdf, 1, max(0.01f, 1e-4f / cosine))
        << "geometry " << hit.geometry_id.value << ", cosine " << cosine;
    EXPECT_FALSE(scene.any_hit(sample->shadow_ray)) << "geometry " << hit.geometry_id.value;
    ++found[hit.geometry_id.value];
  }
  for (std::size_t kind = 0; kind < found.size(); ++kind) EXPECT_GT(found[kind], 20) << "geometry " << kind;
}

}  // namespace
}  // namespace boxwood::render
