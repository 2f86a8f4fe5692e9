// bsdf.h: how does a point of a surface scatter light?
//
// A sum of lobes, each in the share that the Look (material.h) gives it: a coat and a sheen on top; below
// them metal, glass, or a clear boundary over a matte base. A lobe is perfect (a mirror, smooth glass), sends
// light in single directions and can only be sampled, or spread, and can also be evaluated. Laws, held by
// tests: no more light leaves than arrives, and none is lost where theory says so; sample() and evaluate()
// agree.
//
// What lies below a boundary gets what the boundary lets through. Over a matte base both ways count, so that
// the whole is reciprocal. Under coat and sheen only the way of the viewer does, which keeps the energy of
// any base but not the symmetry. Metal gets the light back that bounces on between its facets (Kulla and
// Conty); glass is scaled to lose none (Turquin): see albedo_table.h.
//
// Radiance is not scaled by 1 / ior^2 where it enters glass: the factor cancels on every path that leaves the
// glass again, and leaving it out keeps sheets of glass that are modelled as one surface from shining.
#pragma once

#include <array>
#include <optional>

#include "boxwood/render/material.h"
#include "boxwood/render/warp.h"
#include "boxwood/scene/surface.h"

namespace boxwood::render {

/// A direction that light may come from.
struct BsdfSample {
  Vec3 direction;                ///< Unit length, world space.
  Vec3 weight;                   ///< BSDF * cosine / density.
  float pdf = 0;                 ///< Per solid angle; has no meaning when is_perfect.
  bool is_perfect = false;       ///< From a lobe that no other sampling can find.
  bool is_transmission = false;  ///< To the other side of the surface.
};

struct BsdfValue {
  Vec3 value;     ///< BSDF * cosine, of the spread lobes.
  float pdf = 0;  ///< The density with which sample() finds the direction by its spread lobes.

  void operator+=(const BsdfValue& other) {
    value += other.value;
    pdf += other.pdf;
  }
};

/// Interpolated normals let light fall on faces that point away from it, and the shadow that the faces cast
/// then ends in a jagged line. This fades the light out before. Chiang, Li and Burley, "Taming the Shadow
/// Terminator", SIGGRAPH Talks 2019. The cosines are those between the two normals, and between each of them
/// and the light. 1 on flat faces.
inline float shadow_softening(float alignment, float geometric_cosine, float shading_cosine) {
  const float g = max(0.0f, geometric_cosine) / (shading_cosine * max(alignment, 1e-4f));
  const float softened = g * (1 + g * (1 - g));
  return ((alignment > 0.99999f) | (g >= 1)) ? 1.0f : softened;
}

class Bsdf {
 public:
  /// At `surface`, seen from `outgoing` (unit length, away from the surface). Keeps a reference to `look`.
  /// `normal` is what to shade by, on the side of surface.normal.
  Bsdf(const Look& look, const Surface& surface, Vec3 normal, Vec3 outgoing)
      : Bsdf(look, surface, normal, outgoing, normal) {}
  /// With a coat that has a normal of its own.
  Bsdf(const Look& look, const Surface& surface, Vec3 normal, Vec3 outgoing, Vec3 coat_normal);

  /// Whether there is a spread lobe, which light sources can be sampled for.
  bool has_spread() const { return spread_ != 0; }
  /// Whether one of them reaches behind the surface.
  bool spreads_behind() const { return (spread_ & (1u << through | 1u << glass)) != 0; }

  BsdfValue evaluate(Vec3 incoming) const;

  /// `choice` picks the lobe, `u` the direction in it; all uniform in [0, 1). Nothing where the light is
  /// absorbed.
  std::optional<BsdfSample> sample(float choice, Vec2 u) const;

  /// The geometric normal, turned to the side that it is seen from.
  Vec3 facing_normal() const { return geometric_; }

 private:
  enum Lobe { coat, sheen, metal, specular, diffuse, through, glass, kLobes };
  struct Scattered {  // what one lobe does to one direction
    Vec3 value;
    float pdf = 0;
  };

  void set_shares();
  void set_chances();
  Scattered evaluate_lobe(Lobe lobe, Vec3 incoming) const;
  Scattered evaluate_metal(Vec3 incoming) const;
  Scattered evaluate_glass(Vec3 incoming) const;
  BsdfValue evaluate_local(Vec3 incoming) const;
  Scattered evaluate_coat(Vec3 outgoing, Vec3 incoming) const;
  BsdfValue evaluate_own_coat(Vec3 incoming) const;
  Vec3 outgoing_in(const Frame& of_coat) const;
  std::optional<Vec3> sample_lobe(Lobe lobe, float choice, Vec2 u) const;
  std::optional<BsdfSample> sample_own_coat(Vec2 u) const;
  std::optional<BsdfSample> sample_perfect(Lobe lobe, float choice) const;
  bool is_perfect(Lobe lobe) const;

  Vec3 metal_fresnel(float cosine) const;
  Vec3 specular_fresnel(float cosine) const;
  float coat_albedo(float cosine) const;
  float boundary_albedo(float cosine) const;
  float glass_reflectance(float cosine) const;
  Vec3 to_world(Vec3 local) const { return x_ * local.x + y_ * local.y + z_ * local.z; }

  const Look& look_;
  bool is_inside_;                     // seen from the back of the geometric normal
  unsigned sampled_ = 0, spread_ = 0;  // a bit for each lobe that is sampled at all, and that is spread
  Vec3 geometric_;                     // towards the viewer
  Vec3 x_, y_, z_;                     // the shading frame, z towards the viewer
  Vec3 outgoing_world_;
  Vec3 outgoing_;       // in the shading frame
  Vec3 coat_normal_;    // towards the viewer
  float coat_cosine_;   // between it and the viewer
  bool has_own_coat_;   // its normal is not z_, so that it has a frame of its own
  float eta_;           // glass: the index of refraction of the other side over that of this side
  float alpha_;         // of metal, glass and boundary
  Vec3 diffuse_;        // what the matte base sends back of the light that reaches it
  float boundary_ = 0;  // the share of the clear boundary's reflection, over the matte base
  float passes_ = 1;    // what the boundary lets out this way, over its mean
  std::array<float, kLobes> share_{};   // of the surface's area, less what the layers above take
  std::array<float, kLobes> chance_{};  // of being sampled
  float multiple_ = 0;                  // metal: the share of the light that bounces on between the facets
};

}  // namespace boxwood::render
