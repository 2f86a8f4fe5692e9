#include "boxwood/render/bsdf.h"

#include "boxwood/render/fresnel.h"
#include "boxwood/render/ggx.h"

namespace boxwood::render {
namespace {

/// Below this roughness a lobe is so narrow that single precision cannot hold it apart from a mirror.
constexpr float kSmoothAlpha = 0.001f;

Vec3 mirror(Vec3 v, Vec3 normal) {
  return normal * (2 * dot(v, normal)) - v;
}

}  // namespace

PreparedMaterial::PreparedMaterial(const Material& material)
    : kind(material.kind),
      alpha(material.roughness >= kSmoothAlpha ? min(material.roughness, 1.0f) : 0),
      ior(material.ior >= 1 && material.ior < 10 ? material.ior : 1.5f),
      internal_reflectance(kind == Material::Kind::plastic ? internal_diffuse_reflectance(ior) : 0) {
  if (kind == Material::Kind::mirror || kind == Material::Kind::glass) alpha = 0;
}

Bsdf::Bsdf(const PreparedMaterial& material, Vec3 color, const Surface& surface, Vec3 outgoing)
    : material_(material), color_(color), outgoing_world_(outgoing) {
  // Turn both normals to the viewer. Where an interpolated normal looks away from the viewer all the same, it
  // has gone too far.
  is_inside_ = dot(surface.normal, outgoing) < 0;
  geometric_ = is_inside_ ? -surface.normal : surface.normal;
  z_ = is_inside_ ? -surface.shading_normal : surface.shading_normal;
  if (!(dot(z_, outgoing) > 1e-3f)) z_ = geometric_;
  orthonormal_basis(z_, x_, y_);
  outgoing_ = {dot(x_, outgoing), dot(y_, outgoing), max(dot(z_, outgoing), 1e-5f)};

  if (material_.kind == Material::Kind::glass)
    reflected_ = fresnel_dielectric(min(outgoing_.z, 1.0f), is_inside_ ? 1 / material_.ior : material_.ior);
  if (material_.kind == Material::Kind::plastic)
    reflected_ = fresnel_dielectric(min(outgoing_.z, 1.0f), material_.ior);
}

bool Bsdf::has_spread() const {
  switch (material_.kind) {
    case Material::Kind::mirror:
    case Material::Kind::glass:
      return false;
    case Material::Kind::metal:
      return material_.alpha > 0;
    default:
      return true;
  }
}

BsdfValue Bsdf::evaluate(Vec3 incoming) const {
  // Opaque: nothing comes through the true surface, whatever the interpolated normal says.
  if (!(dot(incoming, geometric_) > 0)) return {};
  return evaluate_local({dot(x_, incoming), dot(y_, incoming), dot(z_, incoming)});
}

std::optional<BsdfSample> Bsdf::sample(float choice, Vec2 u) const {
  switch (material_.kind) {
    case Material::Kind::mirror:
      return sample_mirror(color_);
    case Material::Kind::glass:
      return sample_glass(choice);
    case Material::Kind::metal:
      if (material_.alpha > 0) return sample_spread(choice, u);
      return sample_mirror(fresnel_metal(outgoing_.z, color_));
    case Material::Kind::plastic:
      if (material_.alpha == 0) {
        // Draw the perfect coat or the base below it.
        const float p = coat_probability();
        if (choice < p) return sample_mirror(splat(reflected_ / p));
      }
      return sample_spread(choice, u);
    case Material::Kind::matte:
      break;
  }
  return sample_spread(choice, u);
}

/// How often sample() draws the coat of plastic: in proportion to the light that takes that way, roughly.
float Bsdf::coat_probability() const {
  const float below = (1 - reflected_) * max_component(color_);
  return below > 0 ? reflected_ / (reflected_ + below) : 1;
}

/// Lambert's law; below the coat of plastic, light is reflected back down again and again until it passes the
/// boundary, a geometric series (Saunderson, "Calculation of the Color of Pigmented Plastics", 1942). With
/// the cosine.
Vec3 Bsdf::diffuse(Vec3 incoming) const {
  const float lambert = incoming.z / kPi;
  if (material_.kind == Material::Kind::matte) return color_ * (lambert * shadow_softening(incoming));
  const float passes = (1 - reflected_) * (1 - fresnel_dielectric(min(incoming.z, 1.0f), material_.ior));
  const Vec3 series = color_ / (splat(1) - color_ * material_.internal_reflectance);
  return series * (lambert * passes / (material_.ior * material_.ior));
}

/// Interpolated normals let light fall on faces that point away from it, and the shadow that the faces cast
/// then ends in a jagged line. This fades the light out before. Chiang, Li and Burley, "Taming the Shadow
/// Terminator", SIGGRAPH Talks 2019. 1 on flat faces.
float Bsdf::shadow_softening(Vec3 incoming) const {
  const float alignment = dot(geometric_, z_);
  if (alignment > 0.99999f) return 1;
  const Vec3 world = x_ * incoming.x + y_ * incoming.y + z_ * incoming.z;
  const float g = max(0.0f, dot(geometric_, world)) / (incoming.z * max(alignment, 1e-4f));
  return g >= 1 ? 1 : g * (1 + g * (1 - g));
}

BsdfValue Bsdf::evaluate_local(Vec3 incoming) const {
  if (!(incoming.z > 0)) return {};
  const float cosine_pdf = incoming.z / kPi;

  // The reflection at rough facets, of metal or of a coat.
  Vec3 reflection;
  float reflection_pdf = 0;
  if (material_.alpha > 0) {
    const Ggx ggx{material_.alpha};
    const Vec3 half = normalize(incoming + outgoing_);
    const float cosine = min(dot(outgoing_, half), 1.0f);
    const Vec3 fresnel = material_.kind == Material::Kind::metal
                             ? fresnel_metal(cosine, color_)
                             : splat(fresnel_dielectric(cosine, material_.ior));
    reflection = fresnel * ggx.reflection(outgoing_, incoming, half);
    reflection_pdf = ggx.reflection_pdf(outgoing_, half);
  }

  switch (material_.kind) {
    case Material::Kind::matte:
      return {diffuse(incoming), cosine_pdf};
    case Material::Kind::metal:
      return {reflection, reflection_pdf};
    case Material::Kind::plastic: {
      const float p = coat_probability();
      return {reflection + diffuse(incoming), p * reflection_pdf + (1 - p) * cosine_pdf};
    }
    default:
      return {};
  }
}

std::optional<BsdfSample> Bsdf::sample_spread(float choice, Vec2 u) const {
  const bool at_facets =
      material_.alpha > 0 && (material_.kind == Material::Kind::metal || choice < coat_probability());
  const Vec3 incoming = at_facets
                            ? mirror(outgoing_, Ggx{material_.alpha}.sample_visible_normal(outgoing_, u))
                            : cosine_hemisphere(u);
  BsdfSample sample;
  sample.direction = normalize(x_ * incoming.x + y_ * incoming.y + z_ * incoming.z);
  if (!(dot(sample.direction, geometric_) > 0)) return std::nullopt;
  const BsdfValue value = evaluate_local(incoming);
  if (!(value.pdf > 0)) return std::nullopt;
  sample.weight = value.value / value.pdf;
  sample.pdf = value.pdf;
  return sample;
}

std::optional<BsdfSample> Bsdf::sample_mirror(Vec3 weight) const {
  BsdfSample sample;
  sample.direction = mirror(outgoing_world_, z_);
  // An interpolated normal may send the reflection into the surface; then the face itself is the mirror.
  if (!(dot(sample.direction, geometric_) > 0)) sample.direction = mirror(outgoing_world_, geometric_);
  sample.weight = weight;
  sample.is_perfect = true;
  return sample;
}

std::optional<BsdfSample> Bsdf::sample_glass(float choice) const {
  if (choice < reflected_) return sample_mirror({1, 1, 1});

  // Refract by Snell's law. There is a solution: total reflection would have taken the branch above.
  const float eta = is_inside_ ? material_.ior : 1 / material_.ior;  // this side over the other
  const auto refract = [&](Vec3 normal) {
    const float cosine = dot(outgoing_world_, normal);
    const float other_cosine = std::sqrt(max(0.0f, 1 - eta * eta * (1 - cosine * cosine)));
    return normalize(normal * (eta * cosine - other_cosine) - outgoing_world_ * eta);
  };
  BsdfSample sample;
  sample.direction = refract(z_);
  if (!(dot(sample.direction, geometric_) < 0)) sample.direction = refract(geometric_);
  sample.weight = color_;
  sample.is_perfect = true;
  return sample;
}

}  // namespace boxwood::render
