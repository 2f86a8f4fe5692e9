// path_test.cpp: does light between surfaces come out as theory says? Furnaces, media, mixes, radiosity.
#include "boxwood/render/path.h"

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/render/warp.h"
#include "trace.h"

namespace boxwood::render {
namespace {

using Kind = Material::Kind;

TEST(Path, ConvexMatteUnderAConstantSky) {
  SceneDesc desc;
  const MaterialId matte = desc.add(material_of_kind(Kind::matte, {0.2f, 0.5f, 1}));
  desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}}, matte);
  desc.sky = constant_sky(0.7f);
  const Scene scene(std::move(desc));
  const Vec3 radiance = mean_radiance(scene, Ray{{0.3f, 0.2f, 5}, 0, {0, 0, -1}}, 64);
  EXPECT_NEAR(radiance.x, 0.14f, 1e-5f);
  EXPECT_NEAR(radiance.y, 0.35f, 1e-5f);
  EXPECT_NEAR(radiance.z, 0.70f, 1e-5f);
}

/// A sphere that shines and reflects, from the middle of its inside.
Vec3 inside_a_furnace(float emission, float albedo, int samples, int bounces = kMaxBounces) {
  SceneDesc desc;
  Material material = material_of_kind(Kind::matte, splat(albedo));
  material.emission = splat(emission);
  material.emits_from_both_sides = true;
  desc.add(std::vector<Sphere>{{{1, 2, 3}, 4}}, desc.add(material));
  const Scene scene(std::move(desc));
  return mean_radiance(scene, Ray{{1, 2, 3}, 0, {0.6f, 0, 0.8f}}, samples, bounces);
}

TEST(Path, FurnaceInsideASphereThatShinesAndReflects) {
  // L = E + albedo L, so L = E / (1 - albedo), through many bounces, roulette and next-event estimation.
  EXPECT_NEAR(inside_a_furnace(0.5f, 0.6f, 1 << 14).x, 0.5f / 0.4f, 0.01f);
}

TEST(Path, EachBounceThatIsAllowedAddsItsTermOfTheSeries) {
  // L = E (1 + albedo + albedo^2 + ...), as many terms as there are surfaces on the way.
  float expected = 0, term = 0.5f;
  for (int bounces = 0; bounces <= 6; ++bounces, term *= 0.6f) {
    expected += term;
    EXPECT_NEAR(inside_a_furnace(0.5f, 0.6f, 1 << 13, bounces).x, expected, 0.01f) << bounces;
  }
}

TEST(Path, EveryMaterialInAFurnace) {
  // Under the same light from everywhere, nothing convex can look brighter;
  // what loses nothing looks as bright.
  struct Expectation {
    Material material;
    float least;
  };
  const Expectation expectations[] = {{material_of_kind(Kind::glass, splat(1)), 0.999f},
                                      {material_of_kind(Kind::mirror, splat(1)), 0.999f},
                                      {material_of_kind(Kind::plastic, splat(1)), 0.99f},
                                      {material_of_kind(Kind::plastic, splat(1), 0.3f), 0.985f},
                                      {material_of_kind(Kind::glass, splat(1), 0.4f), 0.985f},
                                      {material_of_kind(Kind::metal, splat(1), 0.1f), 0.985f},
                                      {material_of_kind(Kind::metal, splat(1), 1), 0.985f}};
  for (const auto& [material, least] : expectations) {
    SceneDesc desc;
    desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}}, desc.add(material));
    desc.sky = constant_sky(1);
    const Scene scene(std::move(desc));
    for (const float x : {0.0f, 0.5f, 0.9f}) {
      const float radiance = mean_radiance(scene, Ray{{x, 0.1f, 5}, 0, {0, 0, -1}}, 1 << 12).x;
      EXPECT_LE(radiance, 1.01f) << static_cast<int>(material.kind) << " " << material.roughness << " " << x;
      EXPECT_GE(radiance, least) << static_cast<int>(material.kind) << " " << material.roughness << " " << x;
    }
  }
}

/// The walls of the box [0, 1]^3 as quads that face inwards: -x, +x, -y, +y, -z, +z.
std::vector<Quad> box_walls() {
  return {{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}, {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}},
          {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}, {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}},
          {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}};
}

TEST(Path, ACornellBoxIsWhatRadiositySaysItIs) {
  // An empty box, whose walls all see each other: the radiosity equation B = E + rho K B by finite elements,
  // n x n patches on each wall and form factors between their middles. A red and a green wall, a lit ceiling.
  constexpr int kSide = 20, kPatches = 6 * kSide * kSide;
  const Vec3 colors[6] = {
      {0.63f, 0.06f, 0.05f}, {0.14f, 0.45f, 0.09f}, splat(0.7f), {0, 0, 0}, splat(0.7f), splat(0.7f)};
  const Vec3 glow{3, 2, 1};
  const std::vector<Quad> walls = box_walls();

  struct Patch {
    Vec3 middle, normal;
    int wall;
  };
  std::vector<Patch> patches;
  for (int w = 0; w < 6; ++w)
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const Quad& q = walls[w];
        const float a = (static_cast<float>(i) + 0.5f) / kSide, b = (static_cast<float>(j) + 0.5f) / kSide;
        const Vec3 across = q.b - q.a, along = q.d - q.a;
        patches.push_back({q.a + across * a + along * b, normalize(cross(across, along)), w});
      }
  const auto kernel = [](Vec3 p, Vec3 n, const Patch& from) {
    const Vec3 way = from.middle - p;
    const float d2 = length_squared(way);
    const float cosines = dot(n, way) * -dot(from.normal, way);
    return cosines > 0 ? cosines / (kPi * d2 * d2) / (kSide * kSide) : 0.0f;
  };
  std::vector<float> form(std::size_t(kPatches) * kPatches);
  for (int i = 0; i < kPatches; ++i)
    for (int j = 0; j < kPatches; ++j)
      form[std::size_t(i) * kPatches + j] = kernel(patches[i].middle, patches[i].normal, patches[j]);
  std::vector<Vec3> radiance(kPatches, Vec3{0, 0, 0});
  for (int round = 0; round < 20; ++round) {
    std::vector<Vec3> next(kPatches);
    for (int i = 0; i < kPatches; ++i) {
      Vec3 sum{0, 0, 0};
      for (int j = 0; j < kPatches; ++j) sum += radiance[j] * form[std::size_t(i) * kPatches + j];
      next[i] = (patches[i].wall == 3 ? glow : Vec3{0, 0, 0}) + colors[patches[i].wall] * sum;
    }
    radiance = std::move(next);
  }

  SceneDesc desc;
  for (int w = 0; w < 6; ++w) {
    Material material = material_of_kind(Kind::matte, colors[w]);
    if (w == 3) material.emission = glow;
    desc.add(std::vector<Quad>{walls[w]}, desc.add(material));
  }
  const Scene scene(std::move(desc));
  const Vec3 eye{0.5f, 0.5f, 0.5f};
  for (const int w : {0, 1, 2, 4, 5}) {
    // The middle of each wall, away from edges, where middles of patches do not say enough.
    const Patch& patch = patches[std::size_t(w) * kSide * kSide + kSide / 2 * kSide + kSide / 2];
    const Vec3 found = mean_radiance(scene, Ray{eye, 0, normalize(patch.middle - eye)}, 1 << 14);
    const Vec3 expected = radiance[static_cast<std::size_t>(&patch - patches.data())];
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found[c] / expected[c], 1, 0.02f) << "wall " << w << ", channel " << c;
  }
}

TEST(Path, GlassTakesWhatTheLawOfBeerSays) {
  // Straight through a slab of thickness 2 with absorption a, in a constant sky: T T exp(-2 a) (1 + r^2 +
  // ...) where r = R exp(-2 a) is one way to and fro, and R comes back at once.
  for (const float absorption : {0.0f, 0.3f, 2.0f}) {
    Material glass = material_of_kind(Kind::glass, splat(1));
    glass.absorption = {absorption, 0, 2 * absorption};
    SceneDesc desc;
    desc.add(std::vector<Cuboid>{{{-500, -500, 0}, {500, 500, 2}}}, desc.add(glass));
    desc.sky = constant_sky(1);
    const Scene scene(std::move(desc));
    const Vec3 found = mean_radiance(scene, Ray{{0.1f, 0.2f, 5}, 0, {0, 0, -1}}, 1 << 14);
    const float r = 0.04f;
    for (int c = 0; c < 3; ++c) {
      // All light that comes out, on one side or the other: the sky is the same.
      const float left = std::exp(-2 * (c == 0 ? absorption : c == 1 ? 0 : 2 * absorption));
      const float expected = r + (1 - r) * left * (1 - r) / (1 - r * left);
      EXPECT_NEAR(found[c], expected, 0.004f) << absorption << ", channel " << c;
    }
  }
}

TEST(Path, LightGoesStraightThroughWhatIsNotThere) {
  // A veil over the floor: a share of the light passes, and of what comes back again.
  const auto under = [](const Material& veil) {
    return floor_radiance(
        [&](SceneDesc& desc) {
          desc.add(std::vector<Disk>{{{0, 2, 0}, {0, -3, 0}, 1}}, desc.add(lamp(10)));
          desc.add(std::vector<Quad>{{{-50, 1, -50}, {-50, 1, 50}, {50, 1, 50}, {50, 1, -50}}},
                   desc.add(veil));
        },
        1 << 13);
  };
  const float open = lambert(kPi * 10 / 5);
  EXPECT_NEAR(under(material_of_kind(Kind::clear, splat(1))) / open, 1, 0.01f);
  Material half = material_of_kind(Kind::matte, splat(0));
  half.opacity = 0.5f;
  EXPECT_NEAR(under(half) / open, 0.5f, 0.01f);
  half.alpha_cutoff = 0.6f;  // cut out altogether
  EXPECT_NEAR(under(half) / open, 1, 0.01f);
  half.alpha_cutoff = 0.4f;
  EXPECT_EQ(under(half), 0);

  // The boundary of a medium that fills the space below the veil: the light takes the slanted ways.
  Material fog = material_of_kind(Kind::clear, splat(1));
  fog.outer_absorption = splat(0.5f);  // the quad faces up, so below is behind its back
  fog.absorption = splat(0.5f);
  double expected = 0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const double r = (i + 0.5) / kSteps, d2 = r * r + 4, d = std::sqrt(d2);
    // Half of the way to the lamp is in the medium, and the last half unit to the eye.
    expected += 10 * (2 / d) * (2 / d) / d2 * std::exp(-0.5 * d / 2) * 2 * kPi * r / kSteps;
  }
  // The eye stands in it too, but its ray starts in the clear.
  EXPECT_NEAR(under(fog) / lambert(static_cast<float>(expected)), 1, 0.02f);
}

TEST(Path, AMixIsTheMeanOfItsParts) {
  SceneDesc desc;
  Material mix = material_of_kind(Kind::mix, splat(1));
  mix.first = desc.add(material_of_kind(Kind::matte, {1, 0, 0}));
  mix.second = desc.add(material_of_kind(Kind::matte, {0, 0.5f, 1}));
  mix.mix_amount = 0.25f;
  desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}}, desc.add(mix));
  desc.sky = constant_sky(1);
  const Scene scene(std::move(desc));
  const Vec3 found = mean_radiance(scene, Ray{{0.3f, 0.2f, 5}, 0, {0, 0, -1}}, 1 << 12);
  EXPECT_NEAR(found.x, 0.75f, 0.002f);
  EXPECT_NEAR(found.y, 0.125f, 0.002f);
  EXPECT_NEAR(found.z, 0.25f, 0.002f);
}

TEST(Path, ManyRaysAtOnceSeeWhatEachSeesAlone) {
  SceneDesc desc;
  Material veil = material_of_kind(Kind::plastic, splat(0.6f), 0.2f);
  veil.opacity = 0.7f;
  desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}, {{2, 0, 0}, 0.7f}}, desc.add(veil));
  desc.add(std::vector<Sphere>{{{0, 2, 0}, 0.8f}}, desc.add(material_of_kind(Kind::glass, splat(1), 0.1f)));
  desc.add(std::vector<Disk>{{{0, 4, 0}, {0, -1, 0}, 1}}, desc.add(lamp(10)));
  desc.sky = constant_sky(0.2f);
  const Scene scene(std::move(desc));
  const auto tracer = make_path_tracer(scene, Camera{});
  Random random(4);
  constexpr std::size_t kCount = 5000;  // more than go on together
  std::vector<Ray> rays;
  std::vector<Sampler> samplers;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const Vec3 from = random.direction() * 6.0f;
    rays.push_back({from, 0, normalize(random.direction() - from)});
    samplers.emplace_back(i, i * 7);
  }
  std::vector<Sampler> copies = samplers;
  std::vector<float> together(3 * kCount), alone(3 * kCount);
  const auto counted = std::make_unique<bool[]>(kCount);
  std::vector<RayCounts> traced(kCount), traced_alone(kCount);
  tracer->sample_many(rays, samplers, together, {counted.get(), kCount}, traced);
  for (std::size_t i = 0; i < kCount; ++i)
    EXPECT_TRUE(tracer->sample(rays[i], copies[i], std::span(alone).subspan(3 * i, 3), traced_alone[i]));
  EXPECT_EQ(together, alone);
  EXPECT_EQ(traced, traced_alone);
}

}  // namespace
}  // namespace boxwood::render
