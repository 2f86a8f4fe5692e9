#include "boxwood/render/bsdf.h"

#include <bit>

#include "boxwood/render/fresnel.h"
#include "boxwood/render/sheen.h"

namespace boxwood::render {
namespace {

using Kind = Material::Kind;

constexpr float kCoatIor = 1.5f;

Vec3 mirror(Vec3 v, Vec3 normal) {
  return normal * (2 * dot(v, normal)) - v;
}

float schlick(float cosine) {
  const float x = min(max(0.0f, 1 - cosine), 1.0f), x2 = x * x;
  return x2 * x2 * x;
}

/// Indices of refraction that are so little apart are the same.
constexpr float kAlike = 1e-5f;

}  // namespace

Bsdf::Bsdf(const Look& look, const Surface& surface, Vec3 normal, Vec3 outgoing, Vec3 coat_normal)
    : look_(look), outgoing_world_(outgoing), alpha_(look.alpha) {
  // Turn all normals to the viewer. Where an interpolated normal looks away from the viewer all the same, it
  // has gone too far.
  is_inside_ = dot(surface.normal, outgoing) < 0;
  geometric_ = is_inside_ ? -surface.normal : surface.normal;
  const auto facing = [&](Vec3 n) {
    const Vec3 turned = is_inside_ ? -n : n;
    return dot(turned, outgoing) > 1e-3f ? turned : geometric_;
  };
  const auto cosine = [&](Vec3 n) { return min(max(dot(n, outgoing), 1e-5f), 1.0f); };
  z_ = facing(normal);
  orthonormal_basis(z_, x_, y_);
  outgoing_ = {dot(x_, outgoing), dot(y_, outgoing), cosine(z_)};
  coat_normal_ = facing(coat_normal);
  coat_cosine_ = cosine(coat_normal_);
  has_own_coat_ = look.coat > 0 && coat_normal_ != z_;
  eta_ = is_inside_ && !look.is_thin ? 1 / look.ior : look.ior;

  set_shares();
  set_chances();
}

void Bsdf::set_shares() {
  // How much of the surface is what.
  diffuse_ = look_.color;
  switch (look_.kind) {
    case Kind::matte:
    case Kind::mix:
    case Kind::clear:
      share_[diffuse] = 1;
      break;
    case Kind::translucent:
      share_[diffuse] = share_[through] = 1;
      break;
    case Kind::metal:
    case Kind::mirror:
      share_[metal] = 1;
      break;
    case Kind::glass:
      share_[glass] = 1;
      break;
    case Kind::plastic: {
      share_[diffuse] = share_[specular] = boundary_ = 1;
      // Below the boundary light is reflected back down again and again until it passes, a geometric series
      // (Saunderson, "Calculation of the Color of Pigmented Plastics", 1942).
      const float mean =
          alpha_ > 0 ? look_.prepared->coat_over_base->mean(alpha_) : look_.prepared->fresnel_mean;
      const float leaves = (1 - mean) / (look_.ior * look_.ior);
      diffuse_ = look_.color * leaves / (splat(1) - look_.color * (1 - leaves));
      break;
    }
    case Kind::layered: {
      share_[metal] = look_.metalness;
      share_[glass] = (1 - look_.metalness) * look_.transmission;
      share_[diffuse] = share_[specular] = (1 - look_.metalness) * (1 - look_.transmission);
      boundary_ = share_[specular] > 0 ? look_.specular : 0;
      // Each layer takes its part of what comes from above.
      float below = 1;
      if (look_.coat > 0) {
        share_[coat] = look_.coat;
        below -= look_.coat * coat_albedo(coat_cosine_);
      }
      if (look_.prepared->sheen) {
        share_[sheen] = below;
        below *= 1 - min(1.0f, max_component(look_.sheen_color) *
                                   look_.prepared->sheen->at(look_.sheen_alpha, outgoing_.z));
      }
      for (const Lobe lobe : {metal, specular, diffuse, glass}) share_[lobe] *= below;
      break;
    }
  }
  if (share_[metal] > 0 && alpha_ > 0)
    multiple_ = max(0.0f, 1 - look_.prepared->reflection->at(alpha_, outgoing_.z));
}

/// Lobes are drawn in proportion to the light that takes that way, roughly.
void Bsdf::set_chances() {
  // Most surfaces have one lobe.
  if (look_.kind == Kind::matte) {
    if (!(max_component(diffuse_) > 0)) return;
    chance_[diffuse] = 1;
    sampled_ = spread_ = 1u << diffuse;
    return;
  }
  const float z = outgoing_.z;
  float reflected = 0;
  if (boundary_ > 0) {
    reflected = boundary_ * boundary_albedo(z);
    const float mean =
        alpha_ > 0 ? look_.prepared->coat_over_base->mean(alpha_) : look_.prepared->fresnel_mean;
    passes_ = (1 - reflected) / (1 - boundary_ * mean);
  }
  chance_[coat] = share_[coat] > 0 ? share_[coat] * coat_albedo(coat_cosine_) : 0;
  if (share_[sheen] > 0)
    chance_[sheen] =
        share_[sheen] * max_component(look_.sheen_color) * look_.prepared->sheen->at(look_.sheen_alpha, z);
  if (share_[metal] > 0) chance_[metal] = share_[metal] * max_component(metal_fresnel(z));
  chance_[specular] = share_[specular] * reflected;
  chance_[diffuse] = share_[diffuse] * (1 - reflected) * max_component(diffuse_);
  chance_[through] = share_[through] * max_component(look_.transmission_color);
  if (share_[glass] > 0) {
    const float f = glass_reflectance(z);
    chance_[glass] =
        share_[glass] * (f * max_component(look_.reflection_color) + (1 - f) * max_component(look_.color));
  }
  float sum = 0;
  for (const float chance : chance_) sum += chance;
  for (int lobe = 0; lobe < kLobes; ++lobe) {
    if (!(chance_[lobe] > 0)) continue;
    chance_[lobe] /= sum;
    sampled_ |= 1u << lobe;
    if (!is_perfect(Lobe(lobe))) spread_ |= 1u << lobe;
  }
}

bool Bsdf::is_perfect(Lobe lobe) const {
  switch (lobe) {
    case coat:
      return look_.coat_alpha == 0;
    case glass:
      // Facets between what is alike on both sides bend nothing, and no facet is behind a direction.
      return alpha_ == 0 || (look_.ior < 1 + kAlike && !look_.is_thin);
    case metal:
    case specular:
      return alpha_ == 0;
    default:
      return false;
  }
}

Vec3 Bsdf::metal_fresnel(float cosine) const {
  if (look_.kind == Kind::mirror) return look_.color;
  if (!(max_component(look_.metal_k) > 0)) return fresnel_metal(cosine, look_.color);
  return look_.color * Vec3{fresnel_conductor(cosine, look_.metal_eta.x, look_.metal_k.x),
                            fresnel_conductor(cosine, look_.metal_eta.y, look_.metal_k.y),
                            fresnel_conductor(cosine, look_.metal_eta.z, look_.metal_k.z)};
}

Vec3 Bsdf::specular_fresnel(float cosine) const {
  const Vec3 tint = min(look_.kind == Kind::layered ? look_.specular_color : splat(1), splat(1));
  return (tint + (splat(1) - tint) * schlick(cosine)) *
         (boundary_ * fresnel_dielectric(min(cosine, 1.0f), look_.ior));
}

/// What the clear boundary over the matte base reflects in all, of light at this cosine.
float Bsdf::boundary_albedo(float cosine) const {
  return alpha_ > 0 ? look_.prepared->coat_over_base->at(alpha_, cosine)
                    : fresnel_dielectric(min(cosine, 1.0f), look_.ior);
}

float Bsdf::coat_albedo(float cosine) const {
  return look_.coat_alpha > 0 ? look_.prepared->clear_coat->at(look_.coat_alpha, cosine)
                              : fresnel_dielectric(min(cosine, 1.0f), kCoatIor);
}

float Bsdf::glass_reflectance(float cosine) const {
  const float f = fresnel_dielectric(min(max(cosine, 0.0f), 1.0f), eta_);
  // In a pane light goes to and fro between two such boundaries: f + (1-f)^2 f + (1-f)^2 f^3 + ...
  return look_.is_thin ? 2 * f / (1 + f) : f;
}

BsdfValue Bsdf::evaluate(Vec3 incoming) const {
  // Nothing comes through the true surface but what is meant to, whatever the interpolated normal says.
  const Vec3 local{dot(x_, incoming), dot(y_, incoming), dot(z_, incoming)};
  BsdfValue sum;
  if ((dot(incoming, geometric_) > 0) == (local.z > 0)) sum = evaluate_local(local);
  if (has_own_coat_) sum += evaluate_own_coat(incoming);
  return sum;
}

BsdfValue Bsdf::evaluate_local(Vec3 incoming) const {
  BsdfValue sum;
  const unsigned apart = has_own_coat_ ? 1u << coat : 0;
  for (unsigned left = spread_ & ~apart; left != 0; left &= left - 1) {
    const int lobe = std::countr_zero(left);
    const Scattered part = evaluate_lobe(Lobe(lobe), incoming);
    sum.value += part.value * share_[lobe];
    sum.pdf += part.pdf * chance_[lobe];
  }
  return sum;
}

/// `incoming` is in world space.
BsdfValue Bsdf::evaluate_own_coat(Vec3 incoming) const {
  if (is_perfect(coat) || !(dot(incoming, geometric_) > 0)) return {};
  const Frame frame(coat_normal_);
  const Vec3 in = frame.to_local(incoming), out = outgoing_in(frame);
  if (!(in.z > 0)) return {};
  const Scattered part = evaluate_coat(out, in);
  return {part.value * share_[coat], part.pdf * chance_[coat]};
}

/// In a frame whose z is the normal of the coat.
Bsdf::Scattered Bsdf::evaluate_coat(Vec3 outgoing, Vec3 incoming) const {
  const Ggx ggx{look_.coat_alpha};
  const Vec3 half = normalize(incoming + outgoing);
  const float fresnel = fresnel_dielectric(min(dot(outgoing, half), 1.0f), kCoatIor);
  return {splat(fresnel) * ggx.reflection(outgoing, incoming, half), ggx.reflection_pdf(outgoing, half)};
}

Vec3 Bsdf::outgoing_in(const Frame& of_coat) const {
  const Vec3 local = of_coat.to_local(outgoing_world_);
  return {local.x, local.y, coat_cosine_};
}

Bsdf::Scattered Bsdf::evaluate_lobe(Lobe lobe, Vec3 incoming) const {
  if (lobe == glass) return evaluate_glass(incoming);
  if (lobe == through) {
    if (!(incoming.z < 0)) return {};
    return {look_.transmission_color * (-incoming.z / kPi), -incoming.z / kPi};
  }
  if (!(incoming.z > 0)) return {};

  const float lambert = incoming.z / kPi;
  switch (lobe) {
    case diffuse: {
      if (!(boundary_ > 0)) {
        const float softened =
            shadow_softening(dot(geometric_, z_), dot(geometric_, to_world(incoming)), incoming.z);
        return {diffuse_ * (lambert * softened), lambert};
      }
      // What passes the boundary on the way in and on the way out; on average over all ways in, what passes
      // on the way out alone.
      const float passes = passes_ * (1 - boundary_ * boundary_albedo(incoming.z));
      return {diffuse_ * (lambert * passes), lambert};
    }
    case metal:
      return evaluate_metal(incoming);
    case coat:
      return evaluate_coat(outgoing_, incoming);
    case sheen:
      return {look_.sheen_color * sheen_lobe(look_.sheen_alpha, outgoing_, incoming), 1 / (2 * kPi)};
    default: {
      const Ggx ggx{alpha_};
      const Vec3 half = normalize(incoming + outgoing_);
      const Vec3 fresnel = specular_fresnel(min(dot(outgoing_, half), 1.0f));
      return {fresnel * ggx.reflection(outgoing_, incoming, half), ggx.reflection_pdf(outgoing_, half)};
    }
  }
}

Bsdf::Scattered Bsdf::evaluate_metal(Vec3 incoming) const {
  const Ggx ggx{alpha_};
  const Vec3 half = normalize(incoming + outgoing_);
  const Vec3 fresnel = metal_fresnel(min(dot(outgoing_, half), 1.0f));
  // Light that goes on between the facets leaves in all directions alike, less what each bounce takes.
  const AlbedoTable& table = *look_.prepared->reflection;
  const float mean = table.mean(alpha_), gone = 1 - mean;
  const Vec3 flat = metal_fresnel(1), average = flat + (splat(1) - flat) / 21.0f;
  const Vec3 bounces = average * average * mean / (splat(1) - average * gone);
  const float lambert = incoming.z / kPi;
  const float missing = gone > 1e-6f ? multiple_ * max(0.0f, 1 - table.at(alpha_, incoming.z)) / gone : 0;
  return {fresnel * ggx.reflection(outgoing_, incoming, half) + bounces * (missing * lambert),
          (1 - multiple_) * ggx.reflection_pdf(outgoing_, half) +
              multiple_ * table.nearest(alpha_).missing_density(incoming.z) / (2 * kPi)};
}

Bsdf::Scattered Bsdf::evaluate_glass(Vec3 incoming) const {
  const Ggx ggx{alpha_};
  const bool is_reflection = incoming.z > 0;
  const AlbedoTable& table =
      *(is_inside_ && !look_.is_thin ? look_.prepared->glass_inside : look_.prepared->glass_outside);
  // What the facets' shadows take is given back by scaling.
  const float kept = max(table.at(alpha_, outgoing_.z), 0.01f);

  if (is_reflection || look_.is_thin) {
    // A pane sends light through as if it had been mirrored by the pane.
    const Vec3 reflected{incoming.x, incoming.y, std::fabs(incoming.z)};
    const Vec3 half = normalize(reflected + outgoing_);
    const float f = glass_reflectance(dot(outgoing_, half));
    const float pdf = (is_reflection ? f : 1 - f) * ggx.reflection_pdf(outgoing_, half);
    const float scale = ggx.masking(outgoing_, reflected) / kept;
    return {(is_reflection ? look_.reflection_color : look_.color) * (pdf * scale), pdf};
  }
  // The facet that bends light from one direction into the other: Walter et al. 2007, equations 16 and 17.
  Vec3 half = normalize(outgoing_ + incoming * eta_);
  if (half.z < 0) half = -half;
  const float out = dot(outgoing_, half), in = dot(incoming, half);
  if (!(out > 0) || !(in < 0)) return {};
  const float denominator = out + eta_ * in;
  const float pdf = (1 - glass_reflectance(out)) * ggx.visible_density(outgoing_, half) * eta_ * eta_ * -in /
                    (denominator * denominator);
  if (!(pdf < kInfinity)) return {};
  return {look_.color * (pdf * ggx.masking(outgoing_, incoming) / kept), pdf};
}

std::optional<BsdfSample> Bsdf::sample(float choice, Vec2 u) const {
  // Pick a lobe, and stretch what is left of the choice.
  int last = -1;
  for (unsigned left = sampled_; left != 0; left &= left - 1) {
    last = std::countr_zero(left);
    if (choice < chance_[last]) break;
    choice -= chance_[last];
  }
  if (last < 0) return std::nullopt;
  choice = min(max(choice / chance_[last], 0.0f), 0x1.fffffep-1f);
  if (is_perfect(Lobe(last))) return sample_perfect(Lobe(last), choice);

  if (has_own_coat_ && last == coat) return sample_own_coat(u);
  const std::optional<Vec3> incoming = sample_lobe(Lobe(last), choice, u);
  if (!incoming) return std::nullopt;
  BsdfSample sample;
  sample.direction = normalize(to_world(*incoming));
  sample.is_transmission = incoming->z < 0;
  if ((dot(sample.direction, geometric_) > 0) == sample.is_transmission) return std::nullopt;
  BsdfValue value = evaluate_local(*incoming);
  if (has_own_coat_) value += evaluate_own_coat(sample.direction);
  if (!(value.pdf > 0)) return std::nullopt;
  sample.weight = value.value / value.pdf;
  sample.pdf = value.pdf;
  return sample;
}

std::optional<BsdfSample> Bsdf::sample_own_coat(Vec2 u) const {
  const Frame frame(coat_normal_);
  const Vec3 out = outgoing_in(frame);
  BsdfSample sample;
  sample.direction =
      normalize(frame.to_world(mirror(out, Ggx{look_.coat_alpha}.sample_visible_normal(out, u))));
  if (!(dot(sample.direction, geometric_) > 0)) return std::nullopt;
  const BsdfValue value = evaluate(sample.direction);
  if (!(value.pdf > 0)) return std::nullopt;
  sample.weight = value.value / value.pdf;
  sample.pdf = value.pdf;
  return sample;
}

/// A direction in the frame of the surface; nothing where the facets send the light into the surface.
std::optional<Vec3> Bsdf::sample_lobe(Lobe lobe, float choice, Vec2 u) const {
  switch (lobe) {
    case diffuse:
      return cosine_hemisphere(u);
    case sheen:
      return uniform_cone(u, 1);
    case through: {
      const Vec3 up = cosine_hemisphere(u);
      return Vec3{up.x, up.y, -up.z};
    }
    case metal:
      if (choice < multiple_) {
        // Where it is missing most, mostly at flat angles.
        const float z = look_.prepared->reflection->nearest(alpha_).sample_missing(u.x);
        const float radius = std::sqrt(max(0.0f, 1 - z * z));
        const Vec2 turn = turn_sine_cosine(u.y);
        return Vec3{radius * turn.y, radius * turn.x, z};
      }
      break;
    default:
      break;
  }
  const Ggx ggx{lobe == coat ? look_.coat_alpha : alpha_};
  const Vec3 half = ggx.sample_visible_normal(outgoing_, u);
  const Vec3 reflected = mirror(outgoing_, half);
  if (lobe != glass || choice < glass_reflectance(dot(outgoing_, half)))
    return reflected.z > 0 ? std::optional(reflected) : std::nullopt;
  if (look_.is_thin)
    return reflected.z > 0 ? std::optional(Vec3{reflected.x, reflected.y, -reflected.z}) : std::nullopt;
  const Vec3 refracted = refract(outgoing_, half, 1 / eta_);
  return refracted.z < 0 ? std::optional(refracted) : std::nullopt;
}

std::optional<BsdfSample> Bsdf::sample_perfect(Lobe lobe, float choice) const {
  BsdfSample sample;
  sample.is_perfect = true;
  const float factor = share_[lobe] / chance_[lobe];
  const auto reflect = [&](Vec3 weight) {
    sample.direction = mirror(outgoing_world_, lobe == coat ? coat_normal_ : z_);
    // An interpolated normal may send the reflection into the surface; then the face itself is the mirror.
    if (!(dot(sample.direction, geometric_) > 0)) sample.direction = mirror(outgoing_world_, geometric_);
    sample.weight = weight * factor;
    return sample;
  };
  if (lobe == metal) return reflect(metal_fresnel(outgoing_.z));
  if (lobe == specular) return reflect(specular_fresnel(outgoing_.z));
  if (lobe == coat) return reflect(splat(fresnel_dielectric(coat_cosine_, kCoatIor)));

  // Glass: reflected and refracted light in proportion.
  if (choice < glass_reflectance(outgoing_.z)) return reflect(look_.reflection_color);
  sample.is_transmission = true;
  sample.weight = look_.color * factor;
  if (look_.is_thin) {
    sample.direction = -outgoing_world_;
    return sample;
  }
  sample.direction = refract(outgoing_world_, z_, 1 / eta_);
  if (!(dot(sample.direction, geometric_) < 0))
    sample.direction = refract(outgoing_world_, geometric_, 1 / eta_);
  return sample;
}

}  // namespace boxwood::render
