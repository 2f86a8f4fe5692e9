// Surfaces: energy, reciprocity, and samples that follow the density they claim.
#include "boxwood/render/bsdf.h"

#include <numeric>

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

/// A material at a point, seen from somewhere.
struct Probe {
  Probe(const Material& material, const Surface& surface, Vec3 outgoing)
      : Probe(material, surface, outgoing, surface.shading_normal) {}
  Probe(const Material& material, const Surface& surface, Vec3 outgoing, Vec3 coat_normal)
      : prepared(material),
        look(look_at(SceneDesc{}, material, prepared, TexturePoint(surface))),
        bsdf(look, surface, surface.shading_normal, outgoing, coat_normal) {}
  PreparedMaterial prepared;
  Look look;
  Bsdf bsdf;
};

/// The share of light that comes back in all directions together,
/// as sample() finds it. Of red.
float albedo(const Probe& probe) {
  // Even steps through the choices, since the lobes' weights differ much; 2^14 samples in all.
  constexpr std::uint32_t kChoices = 64, kEach = 256;
  double sum = 0;
  for (std::uint32_t c = 0; c < kChoices; ++c)
    for (std::uint32_t s = 0; s < kEach; ++s) {
      Sampler sampler(c, s);
      const float choice = (static_cast<float>(c) + sampler.next_1d()) / kChoices;
      if (const auto sample = probe.bsdf.sample(choice, sampler.next_2d())) sum += sample->weight.x;
    }
  return static_cast<float>(sum / (kChoices * kEach));
}
float albedo(const Material& material, float cosine, bool from_inside = false) {
  return albedo(Probe(material, flat_surface({0, 0, from_inside ? -1.0f : 1.0f}), at_cosine(cosine)));
}

struct NamedMaterial {
  std::string name;
  Material material;
};

Material layered(float metalness, float transmission, float roughness) {
  Material material = material_of_kind(Kind::layered, splat(1), roughness);
  material.roughness_scale = Material::RoughnessScale::square_root_of_alpha;
  material.metalness = metalness;
  material.transmission = transmission;
  return material;
}

/// One of each kind, white.
std::vector<NamedMaterial> white_materials(std::initializer_list<float> widths = {0.05f, 0.3f, 1.0f}) {
  const Vec3 white{1, 1, 1};
  Material translucent = material_of_kind(Kind::translucent, splat(0.4f));
  translucent.transmission_color = splat(0.6f);
  std::vector<NamedMaterial> all = {{"matte", material_of_kind(Kind::matte, white)},
                                    {"mirror", material_of_kind(Kind::mirror, white)},
                                    {"glass", material_of_kind(Kind::glass, white)},
                                    {"smooth metal", material_of_kind(Kind::metal, white)},
                                    {"smooth plastic", material_of_kind(Kind::plastic, white)},
                                    {"translucent", translucent}};
  for (const float width : widths) {
    const std::string name = " " + std::to_string(width);
    Material pane = material_of_kind(Kind::glass, white, width);
    pane.is_thin = true;
    Material coated = layered(0.5f, 0, width);
    coated.coat = 0.7f;
    coated.coat_roughness = 0.3f;
    Material sheen = layered(0, 0, width);
    sheen.sheen_color = splat(0.5f);
    sheen.sheen_roughness = 0.5f;
    all.push_back({"metal" + name, material_of_kind(Kind::metal, white, width)});
    all.push_back({"plastic" + name, material_of_kind(Kind::plastic, white, width)});
    all.push_back({"rough glass" + name, material_of_kind(Kind::glass, white, width)});
    all.push_back({"pane" + name, pane});
    all.push_back({"layered metal" + name, layered(1, 0, width)});
    all.push_back({"layered plastic" + name, layered(0, 0, width)});
    all.push_back({"layered glass" + name, layered(0, 1, width)});
    all.push_back({"layered in shares" + name, layered(0.3f, 0.5f, width)});
    all.push_back({"coated" + name, coated});
    all.push_back({"sheen" + name, sheen});
  }
  return all;
}

TEST(Bsdf, WhiteFurnaceNothingIsLostAtAnyRoughnessAndAngle) {
  // Light that comes from everywhere alike leaves as bright: from 0.99 to 1.00, but for the noise of 2^14
  // samples.
  constexpr float kNoise = 0.002f;
  for (const auto& [name, material] :
       white_materials({0.002f, 0.02f, 0.1f, 0.2f, 0.35f, 0.5f, 0.7f, 0.85f, 1.0f}))
    for (const float cosine : {1.0f, 0.9f, 0.7f, 0.5f, 0.3f, 0.15f, 0.05f}) {
      const float found = albedo(material, cosine);
      EXPECT_GE(found, 0.99f - kNoise) << name << " at " << cosine;
      EXPECT_LE(found, 1.00f + kNoise) << name << " at " << cosine;
    }
}

TEST(Bsdf, WhiteFurnaceInsideOfGlass) {
  for (const float width : {0.0f, 0.02f, 0.1f, 0.3f, 0.6f, 1.0f})
    for (const float cosine : {1.0f, 0.8f, 0.6f, 0.3f, 0.1f})
      EXPECT_NEAR(albedo(material_of_kind(Kind::glass, splat(1), width), cosine, true), 0.995f, 0.007f)
          << width << " at " << cosine;
}

TEST(Bsdf, GlassThatDoesNotBendLightLetsItPassHoweverRough) {
  for (const float ior : {1.0f, 1.00001f, 1.01f})
    for (const float width : {0.0f, 0.1f, 1.0f})
      for (const bool from_inside : {false, true}) {
        Material air = material_of_kind(Kind::glass, splat(1), width);
        air.ior = ior;
        for (const float cosine : {1.0f, 0.6f, 0.2f})
          EXPECT_NEAR(albedo(air, cosine, from_inside), 1, 0.02f) << ior << " " << width << " at " << cosine;
      }
  Material air = layered(0, 1, 0.5f);
  air.ior = 1;
  const Vec3 outgoing = at_cosine(0.6f);
  const auto sample = Probe(air, flat_surface({0, 0, 1}), outgoing).bsdf.sample(0.5f, {0.5f, 0.5f});
  ASSERT_TRUE(sample);
  EXPECT_LT(length(sample->direction + outgoing), 1e-6f);
  EXPECT_NEAR(sample->weight.x, 1, 1e-6f);
}

TEST(Bsdf, ColoredMaterialsReflectLess) {
  for (const float cosine : {1.0f, 0.7f, 0.3f, 0.05f}) {
    EXPECT_NEAR(albedo(material_of_kind(Kind::matte, splat(0.3f)), cosine), 0.3f, 1e-4f);
    EXPECT_NEAR(albedo(material_of_kind(Kind::mirror, splat(0.7f)), cosine), 0.7f, 1e-4f);
    // Light that goes on between facets is colored more than once.
    EXPECT_LT(albedo(material_of_kind(Kind::metal, splat(0.5f), 0.8f), cosine), 0.75f);
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
    const Vec3 normal = random.direction();
    const Frame frame(normal);
    const Vec3 outgoing = frame.to_world(at_cosine(0.6f));
    const Probe probe(material, flat_surface(normal), outgoing);
    for (int i = 0; i < 500; ++i) {
      const float choice = random.uniform();
      const auto sample = probe.bsdf.sample(choice, {random.uniform(), random.uniform()});
      if (!sample) continue;
      EXPECT_NEAR(length(sample->direction), 1, 1e-4f) << name;
      EXPECT_EQ(sample->is_transmission, dot(sample->direction, normal) < 0) << name;
      if (sample->is_perfect) continue;
      const BsdfValue value = probe.bsdf.evaluate(sample->direction);
      // Narrow lobes feel the rounding of the direction.
      EXPECT_NEAR(value.pdf / sample->pdf, 1, 0.03f) << name;
      EXPECT_NEAR(length(value.value - sample->weight * sample->pdf) / length(value.value), 0, 0.03f) << name;
    }
  }
}

/// The quantile of the chi-square distribution that one honest test in 10^5 exceeds: Wilson and Hilferty,
/// 1931.
double chi_square_limit(int degrees) {
  const double z = 4.27, k = degrees;
  return k * std::pow(1 - 2 / (9 * k) + z * std::sqrt(2 / (9 * k)), 3);
}

/// In cells of equal solid angle over the whole sphere: how often sample() comes there, and the integral of
/// the density that evaluate() states. What sample() gives up, or draws from perfect lobes, is a cell too: so
/// the density integrates to what it should.
void expect_samples_follow_density(const Bsdf& bsdf, const std::string& name) {
  constexpr int kRings = 8, kSectors = 8, kCount = 100000, kSteps = 48;
  std::vector<double> found(kRings * kSectors + 1), expected(kRings * kSectors + 1);
  const auto cell_of = [&](float z, float angle) {
    const int ring = std::min(static_cast<int>((z + 1) / 2 * kRings), kRings - 1);
    const int sector = std::min(static_cast<int>(angle / (2 * kPi) * kSectors), kSectors - 1);
    return static_cast<std::size_t>(ring * kSectors + sector);
  };
  Random random(11);
  for (int s = 0; s < kCount; ++s) {
    const float choice = random.uniform();
    const auto sample = bsdf.sample(choice, {random.uniform(), random.uniform()});
    if (!sample || sample->is_perfect) {
      found.back() += 1;
      continue;
    }
    const float angle = std::atan2(sample->direction.y, sample->direction.x);
    found[cell_of(sample->direction.z, angle < 0 ? angle + 2 * kPi : angle)] += 1;
  }
  for (int i = 0; i < kRings * kSteps; ++i)
    for (int j = 0; j < kSectors * kSteps; ++j) {
      const float z = 2 * (static_cast<float>(i) + 0.5f) / (kRings * kSteps) - 1;
      const float angle = 2 * kPi * (static_cast<float>(j) + 0.5f) / (kSectors * kSteps),
                  r = std::sqrt(1 - z * z);
      const double cell = 4 * kPi / (kRings * kSectors * kSteps * kSteps);
      expected[cell_of(z, angle)] +=
          kCount * cell * bsdf.evaluate({r * std::cos(angle), r * std::sin(angle), z}).pdf;
    }
  const double all = std::accumulate(expected.begin(), expected.end(), 0.0);
  EXPECT_LE(all, kCount * 1.002) << name;
  expected.back() = std::max(0.0, kCount - all);

  // Cells in which little is expected are one cell together.
  double chi_square = 0, few_found = 0, few_expected = 0;
  int degrees = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (expected[i] < 20) {
      few_found += found[i];
      few_expected += expected[i];
      continue;
    }
    // The grid is exact to some thousandths.
    const double off = std::max(0.0, std::fabs(found[i] - expected[i]) - 0.004 * expected[i]);
    chi_square += off * off / expected[i];
    ++degrees;
  }
  EXPECT_NEAR(few_found, few_expected, 5 * std::sqrt(few_expected + 1) + 0.001 * kCount) << name;
  EXPECT_LT(chi_square, chi_square_limit(degrees - 1)) << name;
}

TEST(Bsdf, SamplesFollowTheirDensityByChiSquare) {
  for (const auto& [name, material] : white_materials({0.2f, 0.5f, 1.0f}))
    for (const bool from_inside : {false, true}) {
      const Probe probe(material, flat_surface({0, 0, from_inside ? -1.0f : 1.0f}), at_cosine(0.5f));
      if (probe.bsdf.has_spread())
        expect_samples_follow_density(probe.bsdf, name + (from_inside ? " from inside" : ""));
    }
}

/// A coat whose normal is not that of what it lies on, rough or smooth.
TEST(Bsdf, ACoatMayHaveANormalOfItsOwn) {
  const Vec3 outgoing = at_cosine(0.8f);
  for (const float tilt : {0.2f, 0.6f, -0.4f})
    for (const float roughness : {0.0f, 0.5f, 0.8f})
      for (const float transmission : {0.0f, 0.5f}) {
        const std::string name =
            std::to_string(tilt) + " " + std::to_string(roughness) + " " + std::to_string(transmission);
        Material coated = layered(0.2f, transmission, 0.5f);
        coated.coat = 0.7f;
        coated.coat_roughness = roughness;
        const Vec3 coat_normal = normalize(Vec3{tilt, 0.1f, 1});
        const Probe probe(coated, flat_surface({0, 0, 1}), outgoing, coat_normal);
        // No more leaves than arrives; what the coat sends into the surface is lost.
        EXPECT_LE(albedo(probe), 1.002f) << name;
        EXPECT_GE(albedo(probe), 0.95f) << name;
        expect_samples_follow_density(probe.bsdf, name);
        Random random(9);
        for (int i = 0; i < 500; ++i) {
          const float choice = random.uniform();
          const auto sample = probe.bsdf.sample(choice, {random.uniform(), random.uniform()});
          if (!sample) continue;
          if (sample->is_perfect) {  // the coat, as a mirror
            EXPECT_LT(length(normalize(sample->direction + outgoing) - coat_normal), 1e-4f) << name;
            continue;
          }
          const BsdfValue value = probe.bsdf.evaluate(sample->direction);
          EXPECT_NEAR(value.pdf / sample->pdf, 1, 1e-3f) << name;
          EXPECT_NEAR(length(value.value - sample->weight * sample->pdf) / length(value.value), 0, 1e-3f)
              << name;
        }
      }
}

TEST(Bsdf, OpaqueMaterialsWithoutLayersAreReciprocal) {
  Random random(5);
  for (const auto& [name, material] : white_materials()) {
    // Layers keep the energy of any base by looking at one of the two directions only; so does glass.
    if (material.kind == Kind::glass || material.coat > 0 || max_component(material.sheen_color) > 0 ||
        material.transmission > 0)
      continue;
    for (int i = 0; i < 100; ++i) {
      const Vec3 a = uniform_cone({random.uniform(), random.uniform()}, 0.95f);
      const Vec3 b = uniform_cone({random.uniform(), random.uniform()}, 0.95f);
      const Surface surface = flat_surface({0, 0, 1});
      const float there = Probe(material, surface, a).bsdf.evaluate(b).value.x / b.z;
      const float back = Probe(material, surface, b).bsdf.evaluate(a).value.x / a.z;
      EXPECT_NEAR(there, back, 2e-3f * std::max(there, 1.0f)) << name;
    }
  }
}

TEST(Bsdf, OpaqueMaterialsNeverLookThroughTheSurface) {
  Random random(6);
  for (const auto& [name, material] : white_materials()) {
    if (material.kind == Kind::glass || material.kind == Kind::translucent || material.transmission > 0)
      continue;
    for (int i = 0; i < 500; ++i) {
      // Interpolated normals that lean up to 80 degrees.
      Surface surface = flat_surface({0, 0, 1});
      surface.shading_normal =
          normalize(Vec3{0, 0, 1} + uniform_cone({random.uniform(), random.uniform()}, 1) * 5.0f);
      const float side = i % 2 ? 1.0f : -1.0f;
      const Vec3 outgoing = uniform_cone({random.uniform(), random.uniform()}, 1) * side;
      const Probe probe(material, surface, outgoing);
      EXPECT_GT(dot(probe.bsdf.facing_normal(), outgoing), -1e-6f);
      const float choice = random.uniform();
      const auto sample = probe.bsdf.sample(choice, {random.uniform(), random.uniform()});
      if (sample) {
        EXPECT_GT(sample->direction.z * side, 0) << name;
        EXPECT_TRUE(is_finite(sample->weight));
      }
      const Vec3 below = uniform_cone({random.uniform(), random.uniform()}, 1) * -side;
      EXPECT_EQ(probe.bsdf.evaluate(below).value, Vec3{}) << name;
    }
  }
}

TEST(Bsdf, GlassRefractsBySnell) {
  const Material glass = material_of_kind(Kind::glass, {1, 1, 1});
  const Vec3 outgoing = at_cosine(0.8f);
  const auto into = Probe(glass, flat_surface({0, 0, 1}), outgoing).bsdf.sample(0.999f, {});
  ASSERT_TRUE(into);
  EXPECT_LT(into->direction.z, 0);
  EXPECT_NEAR(into->direction.x, -outgoing.x / 1.5f, 1e-6f);

  // From inside at a flat angle everything is reflected.
  const auto inside = Probe(glass, flat_surface({0, 0, -1}), at_cosine(0.5f)).bsdf.sample(0.999f, {});
  ASSERT_TRUE(inside);
  EXPECT_GT(inside->direction.z, 0);
}

TEST(Bsdf, RoughGlassSpreadsAroundTheRefractedRay) {
  // The mean direction of what is let through is that of smooth glass, nearly.
  const Probe probe(material_of_kind(Kind::glass, {1, 1, 1}, 0.05f), flat_surface({0, 0, 1}),
                    at_cosine(0.8f));
  Random random(8);
  Vec3 sum{0, 0, 0};
  for (int i = 0; i < 20000; ++i) {
    const float choice = random.uniform();
    const auto sample = probe.bsdf.sample(choice, {random.uniform(), random.uniform()});
    if (sample && sample->is_transmission) sum += sample->direction;
  }
  const Vec3 mean = normalize(sum);
  EXPECT_NEAR(mean.x, -0.6f / 1.5f, 0.005f);
  EXPECT_NEAR(mean.y, 0, 0.005f);
}

TEST(Bsdf, APaneReflectsTheSumOfItsInnerReflections) {
  // R + (1-R)^2 R + (1-R)^2 R^3 + ...; the rest goes straight on.
  Material pane = material_of_kind(Kind::glass, {1, 1, 1});
  pane.is_thin = true;
  const Probe probe(pane, flat_surface({0, 0, 1}), at_cosine(0.4f));
  const float r = fresnel_dielectric(0.4f, 1.5f);
  float sum = r, left = (1 - r) * (1 - r) * r;
  for (int i = 0; i < 50; ++i, left *= r * r) sum += left;
  Random random(2);
  int reflected = 0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const auto sample = probe.bsdf.sample(random.uniform(), {});
    ASSERT_TRUE(sample);
    if (sample->is_transmission) {
      EXPECT_LE(length(sample->direction + at_cosine(0.4f)), 1e-6f);
    }
    reflected += !sample->is_transmission;
  }
  EXPECT_NEAR(static_cast<float>(reflected) / kCount, sum, 0.005f);
}

TEST(Fresnel, ClosedForms) {
  EXPECT_NEAR(fresnel_dielectric(1, 1.5f), 0.04f, 1e-6f);
  EXPECT_NEAR(fresnel_dielectric(0, 1.5f), 1, 1e-6f);
  EXPECT_EQ(fresnel_dielectric(0.5f, 1 / 1.5f), 1);  // total reflection
  // Brewster's angle: only one polarization is reflected, and of that the square of (n^2 - 1) / (n^2 + 1).
  const float n2 = 1.5f * 1.5f, cosine = 1 / std::sqrt(1 + n2);
  const float amplitude = (n2 - 1) / (n2 + 1);
  EXPECT_NEAR(fresnel_dielectric(cosine, 1.5f), 0.5f * amplitude * amplitude, 1e-6f);
  // The same from both sides.
  const float inner = std::sqrt(1 - (1 - 0.3f * 0.3f) / n2);
  EXPECT_NEAR(fresnel_dielectric(0.3f, 1.5f), fresnel_dielectric(inner, 1 / 1.5f), 1e-5f);

  // Published: 0.596 for an index of 1.5 (Judd, 1942).
  EXPECT_NEAR(internal_diffuse_reflectance(1.5f), 0.596f, 0.002f);

  // A metal head-on: ((n-1)^2 + k^2) / ((n+1)^2 + k^2); without absorption it is a dielectric.
  EXPECT_NEAR(fresnel_conductor(1, 0.2f, 3.9f), (0.64f + 15.21f) / (1.44f + 15.21f), 1e-5f);
  EXPECT_NEAR(fresnel_conductor(0, 0.2f, 3.9f), 1, 1e-5f);
  for (const float c : {0.9f, 0.5f, 0.2f})
    EXPECT_NEAR(fresnel_conductor(c, 1.5f, 0), fresnel_dielectric(c, 1.5f), 1e-5f);
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

TEST(AlbedoTable, AgreesWithWhatItIsAnIntegralOf) {
  // A finer integral by the midpoint rule over the sphere of normals, at widths between the table's own rows.
  const AlbedoTable table(AlbedoTable::Lobe::reflection, 1, -1);
  for (const float alpha : {0.13f, 0.44f, 0.93f})
    for (const float cosine : {0.95f, 0.5f, 0.22f}) {
      const Ggx ggx{alpha};
      const Vec3 outgoing = at_cosine(cosine);
      double sum = 0;
      constexpr int kSteps = 400;
      for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
          const float z = (static_cast<float>(i) + 0.5f) / kSteps, r = std::sqrt(1 - z * z),
                      angle = 2 * kPi * (static_cast<float>(j) + 0.5f) / kSteps;
          const Vec3 incoming{r * std::cos(angle), r * std::sin(angle), z};
          sum += ggx.reflection(outgoing, incoming, normalize(outgoing + incoming));
        }
      EXPECT_NEAR(table.at(alpha, cosine), sum * 2 * kPi / (kSteps * kSteps), 0.004f)
          << alpha << " " << cosine;
    }
}

}  // namespace
}  // namespace boxwood::render
