// Surfaces: energy, reciprocity, and samples that follow the density they claim.
#include "boxwood/render/bsdf.h"

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/render/fresnel.h"
#include "boxwood/render/ggx.h"
#include "trace.h"

namespace boxwood::render {
namespace {

using Kind = Material::Kind;

Surface flat_surface(Vec3 normal) {
  Surface surface{};
  surface.normal = surface.shading_normal = normal;
  return surface;
}

/// Unit length, at an angle to +z with this cosine.
Vec3 at_cosine(float cosine) {
  return {std::sqrt(1 - cosine * cosine), 0, cosine};
}

/// The share of light that comes back in all directions together,
/// as sample() finds it. `bounded` is that of red.
float albedo(const Material& material, float cosine, int count = 1 << 14) {
  const PreparedMaterial prepared(material);
  const Bsdf bsdf(prepared, material.color, flat_surface({0, 0, 1}), at_cosine(cosine));
  double sum = 0;
  for (int s = 0; s < count; ++s) {
    Sampler sampler(1, static_cast<std::uint32_t>(s));
    const float choice = sampler.next_1d();
    if (const auto sample = bsdf.sample(choice, sampler.next_2d())) sum += sample->weight.x;
  }
  return static_cast<float>(sum / count);
}

struct NamedMaterial {
  const char* name;
  Material material;
};

std::vector<NamedMaterial> white_materials() {
  const Vec3 white{1, 1, 1};
  return {{"matte", material_of_kind(Kind::matte, white)},
          {"mirror", material_of_kind(Kind::mirror, white)},
          {"glass", material_of_kind(Kind::glass, white)},
          {"smooth metal", material_of_kind(Kind::metal, white)},
          {"metal 0.05", material_of_kind(Kind::metal, white, 0.05f)},
          {"metal 0.3", material_of_kind(Kind::metal, white, 0.3f)},
          {"metal 1", material_of_kind(Kind::metal, white, 1)},
          {"smooth plastic", material_of_kind(Kind::plastic, white)},
          {"plastic 0.1", material_of_kind(Kind::plastic, white, 0.1f)},
          {"plastic 0.5", material_of_kind(Kind::plastic, white, 0.5f)}};
}

TEST(Bsdf, WhiteFurnaceNoMoreLeavesThanArrives) {
  for (const auto& [name, material] : white_materials())
    for (const float cosine : {1.0f, 0.9f, 0.5f, 0.2f, 0.05f})
      EXPECT_LE(albedo(material, cosine), 1.004f) << name << " at " << cosine;
}

TEST(Bsdf, WhiteFurnaceNothingIsLostWhereTheorySaysSo) {
  for (const float cosine : {1.0f, 0.7f, 0.3f, 0.05f}) {
    EXPECT_NEAR(albedo(material_of_kind(Kind::matte, splat(1)), cosine), 1, 1e-4f);
    EXPECT_NEAR(albedo(material_of_kind(Kind::matte, splat(0.3f)), cosine), 0.3f, 1e-4f);
    EXPECT_NEAR(albedo(material_of_kind(Kind::mirror, splat(0.7f)), cosine), 0.7f, 1e-4f);
    EXPECT_NEAR(albedo(material_of_kind(Kind::glass, splat(1)), cosine), 1, 1e-4f);
    EXPECT_NEAR(albedo(material_of_kind(Kind::plastic, splat(1)), cosine), 1, 0.003f) << cosine;
    // At flat angles even small roughness loses light to second bounces between facets.
    if (cosine >= 0.3f) {
      EXPECT_NEAR(albedo(material_of_kind(Kind::metal, splat(1), 0.02f), cosine), 1, 0.01f) << cosine;
    }
  }
}

TEST(Bsdf, PlasticReflectsWhatTheSeriesOfInnerReflectionsGives) {
  // (1 - F) of the light enters; (1 - Fi) of it leaves each time that it comes up, a share of `c` survives
  // each time down.
  const float c = 0.4f, fi = internal_diffuse_reflectance(1.5f);
  const float f = fresnel_dielectric(0.6f, 1.5f);
  const float expected = f + (1 - f) * c * (1 - fi) / (1 - c * fi);
  EXPECT_NEAR(albedo(material_of_kind(Kind::plastic, splat(c)), 0.6f), expected, 0.002f);
}

TEST(Bsdf, SampleAndEvaluateAgree) {
  Random random(3);
  for (const auto& [name, material] : white_materials()) {
    const PreparedMaterial prepared(material);
    const Vec3 normal = random.direction();
    const Frame frame(normal);
    const Vec3 outgoing = frame.to_world(at_cosine(0.6f));
    const Bsdf bsdf(prepared, material.color, flat_surface(normal), outgoing);
    for (int i = 0; i < 500; ++i) {
      const float choice = random.uniform();
      const auto sample = bsdf.sample(choice, {random.uniform(), random.uniform()});
      if (!sample) continue;
      EXPECT_NEAR(length(sample->direction), 1, 1e-4f) << name;
      if (sample->is_perfect) continue;
      const BsdfValue value = bsdf.evaluate(sample->direction);
      // Narrow lobes feel the rounding of the direction.
      EXPECT_NEAR(value.pdf / sample->pdf, 1, 0.02f) << name;
      EXPECT_NEAR(length(value.value - sample->weight * sample->pdf) / length(value.value), 0, 0.02f) << name;
    }
  }
}

TEST(Bsdf, SamplesFollowTheirDensity) {
  // In cells of equal solid angle:
  // how often sample() comes there, and the integral of the density that evaluate() states.
  constexpr int kRings = 4, kSectors = 8, kCount = 200000, kSteps = 24;
  for (const auto& [name, material] : white_materials()) {
    const PreparedMaterial prepared(material);
    const Bsdf bsdf(prepared, material.color, flat_surface({0, 0, 1}), at_cosine(0.5f));
    if (!bsdf.has_spread() || (prepared.alpha > 0 && prepared.alpha < 0.2f))
      continue;  // too narrow for this grid

    std::vector<double> found(kRings * kSectors), expected(kRings * kSectors);
    const auto cell_of = [&](float z, float angle) {
      const int ring = std::min(static_cast<int>(z * kRings), kRings - 1);
      const int sector = std::min(static_cast<int>(angle / (2 * kPi) * kSectors), kSectors - 1);
      return static_cast<std::size_t>(ring * kSectors + sector);
    };
    for (int s = 0; s < kCount; ++s) {
      Sampler sampler(9, static_cast<std::uint32_t>(s));
      const float choice = sampler.next_1d();
      const auto sample = bsdf.sample(choice, sampler.next_2d());
      if (!sample || sample->is_perfect) continue;
      const float angle = std::atan2(sample->direction.y, sample->direction.x);
      found[cell_of(sample->direction.z, angle < 0 ? angle + 2 * kPi : angle)] += 1.0 / kCount;
    }
    for (int i = 0; i < kRings * kSteps; ++i)
      for (int j = 0; j < kSectors * kSteps; ++j) {
        const float z = (static_cast<float>(i) + 0.5f) / (kRings * kSteps);
        const float angle = 2 * kPi * (static_cast<float>(j) + 0.5f) / (kSectors * kSteps),
                    r = std::sqrt(1 - z * z);
        const double cell = 2 * kPi / (kRings * kSectors * kSteps * kSteps);
        expected[cell_of(z, angle)] +=
            cell * bsdf.evaluate({r * std::cos(angle), r * std::sin(angle), z}).pdf;
      }
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i], expected[i], 0.004) << name << ", cell " << i;
  }
}

TEST(Bsdf, SpreadPartsAreReciprocal) {
  Random random(5);
  for (const auto& [name, material] : white_materials()) {
    const PreparedMaterial prepared(material);
    for (int i = 0; i < 100; ++i) {
      const Vec3 a = uniform_cone({random.uniform(), random.uniform()}, 0.95f);
      const Vec3 b = uniform_cone({random.uniform(), random.uniform()}, 0.95f);
      const Surface surface = flat_surface({0, 0, 1});
      const float there = Bsdf(prepared, material.color, surface, a).evaluate(b).value.x / b.z;
      const float back = Bsdf(prepared, material.color, surface, b).evaluate(a).value.x / a.z;
      EXPECT_NEAR(there, back, 1e-3f * std::max(there, 1.0f)) << name;
    }
  }
}

TEST(Bsdf, OpaqueMaterialsNeverLookThroughTheSurface) {
  Random random(6);
  for (const auto& [name, material] : white_materials()) {
    if (material.kind == Kind::glass) continue;
    const PreparedMaterial prepared(material);
    for (int i = 0; i < 2000; ++i) {
      // Interpolated normals that lean up to 80 degrees.
      Surface surface = flat_surface({0, 0, 1});
      surface.shading_normal =
          normalize(Vec3{0, 0, 1} + uniform_cone({random.uniform(), random.uniform()}, 1) * 5.0f);
      const float side = i % 2 ? 1.0f : -1.0f;
      const Vec3 outgoing = uniform_cone({random.uniform(), random.uniform()}, 1) * side;
      const Bsdf bsdf(prepared, material.color, surface, outgoing);
      EXPECT_GT(dot(bsdf.facing_normal(), outgoing), -1e-6f);
      const float choice = random.uniform();
      const auto sample = bsdf.sample(choice, {random.uniform(), random.uniform()});
      if (sample) {
        EXPECT_GT(sample->direction.z * side, 0) << name;
        EXPECT_TRUE(is_finite(sample->weight));
      }
      const Vec3 below = uniform_cone({random.uniform(), random.uniform()}, 1) * -side;
      EXPECT_EQ(bsdf.evaluate(below).value, Vec3{}) << name;
    }
  }
}

TEST(Bsdf, GlassRefractsBySnell) {
  const PreparedMaterial prepared(material_of_kind(Kind::glass, {1, 1, 1}));
  const Vec3 outgoing = at_cosine(0.8f);
  const auto into = Bsdf(prepared, {1, 1, 1}, flat_surface({0, 0, 1}), outgoing).sample(0.999f, {});
  ASSERT_TRUE(into);
  EXPECT_LT(into->direction.z, 0);
  EXPECT_NEAR(into->direction.x, -outgoing.x / 1.5f, 1e-6f);

  // From inside at a flat angle everything is reflected.
  const auto inside = Bsdf(prepared, {1, 1, 1}, flat_surface({0, 0, -1}), at_cosine(0.5f)).sample(0.999f, {});
  ASSERT_TRUE(inside);
  EXPECT_GT(inside->direction.z, 0);
}

TEST(Fresnel, KnownValues) {
  EXPECT_NEAR(fresnel_dielectric(1, 1.5f), 0.04f, 1e-6f);
  EXPECT_NEAR(fresnel_dielectric(1, 1 / 1.5f), 0.04f, 1e-6f);
  EXPECT_EQ(fresnel_dielectric(0.2f, 1 / 1.5f), 1);
  EXPECT_NEAR(fresnel_dielectric(0, 1.5f), 1, 1e-6f);
  EXPECT_EQ(fresnel_dielectric(0.37f, 1), 0);
  // Brewster's angle, tan = eta: half of the light is not reflected at all,
  // the rest by ((eta^2 - 1) / (eta^2 + 1))^2.
  const float brewster = 1 / std::sqrt(1 + 1.5f * 1.5f), perpendicular = 1.25f / 3.25f;
  EXPECT_NEAR(fresnel_dielectric(brewster, 1.5f), 0.5f * perpendicular * perpendicular, 1e-6f);
  // Published: 0.596 for an index of 1.5 (Judd, 1942).
  EXPECT_NEAR(internal_diffuse_reflectance(1.5f), 0.596f, 0.002f);
}

TEST(Ggx, NormalsCoverTheProjectedArea) {
  for (const float alpha : {0.1f, 0.4f, 1.0f}) {
    const Ggx ggx{alpha};
    double area = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const float z = (static_cast<float>(i) + 0.5f) / kSteps;
      area += 2 * kPi / kSteps * z * ggx.density({std::sqrt(1 - z * z), 0, z});
    }
    EXPECT_NEAR(area, 1, 1e-3) << alpha;
  }
}

}  // namespace
}  // namespace boxwood::render
