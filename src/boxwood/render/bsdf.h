// bsdf.h: how does a point of a surface scatter light?
//
// One class for all kinds of material. Each is a sum of at most two parts: a perfect one (mirror, glass, a
// smooth coat), which sends light in single directions and can only be sampled, and a spread one (Lambert,
// GGX), which can also be evaluated. Laws, held by tests: no more light leaves than arrives; sample() and
// evaluate() agree.
//
// Radiance is not scaled by 1 / ior^2 where it enters glass: the factor cancels on every path that leaves the
// glass again, and leaving it out keeps sheets of glass that are modelled as one surface from shining.
#pragma once

#include <optional>

#include "boxwood/scene/surface.h"

namespace boxwood::render {

/// A direction that light may come from.
struct BsdfSample {
  Vec3 direction;           ///< Away from the surface; unit length, world space.
  Vec3 weight;              ///< BSDF * cosine / density.
  float pdf = 0;            ///< Per solid angle; has no meaning when is_perfect.
  bool is_perfect = false;  ///< From the part that no other sampling can find.
};

struct BsdfValue {
  Vec3 value;     ///< BSDF * cosine, of the spread part.
  float pdf = 0;  ///< The density with which sample() finds the direction by its spread part.
};

/// What of a material does not depend on the place.
struct PreparedMaterial {
  explicit PreparedMaterial(const Material& material);

  Material::Kind kind;
  float alpha;  ///< 0 where the reflection is perfect.
  float ior;
  float internal_reflectance;  ///< Plastic: of diffuse light at the coat, from below.
};

class Bsdf {
 public:
  /// At `surface`, seen from `outgoing` (unit length, away from the surface). `color` is in [0, 1].
  Bsdf(const PreparedMaterial& material, Vec3 color, const Surface& surface, Vec3 outgoing);

  /// Whether there is a spread part, which light sources can be sampled for.
  bool has_spread() const;

  BsdfValue evaluate(Vec3 incoming) const;

  /// `choice` picks the part, `u` the direction in it; all uniform in [0, 1). Nothing where the light is
  /// absorbed.
  std::optional<BsdfSample> sample(float choice, Vec2 u) const;

  /// The geometric normal, turned to the side that it is seen from.
  Vec3 facing_normal() const { return geometric_; }

 private:
  BsdfValue evaluate_local(Vec3 incoming) const;
  Vec3 diffuse(Vec3 incoming) const;
  float coat_probability() const;
  float shadow_softening(Vec3 incoming) const;
  std::optional<BsdfSample> sample_mirror(Vec3 weight) const;
  std::optional<BsdfSample> sample_glass(float choice) const;
  std::optional<BsdfSample> sample_spread(float choice, Vec2 u) const;

  const PreparedMaterial& material_;
  Vec3 color_;
  bool is_inside_;  // seen from the back of the geometric normal
  Vec3 geometric_;  // towards the viewer
  Vec3 x_, y_, z_;  // the shading frame, z towards the viewer
  Vec3 outgoing_world_;
  Vec3 outgoing_;        // in the shading frame
  float reflected_ = 0;  // glass and plastic: the share that the boundary reflects
};

}  // namespace boxwood::render
