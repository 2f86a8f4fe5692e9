// ggx.h: how does a rough surface spread a reflection?
//
// A microfacet model: the surface is made of tiny mirrors whose normals follow the GGX distribution (Walter
// et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007). Normals are drawn from those
// visible from the outgoing direction: Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 2018,
// in the form of Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023. Light that
// bounces twice between facets is not accounted for here, so rough surfaces lose some of it: albedo_table.h
// says how much. All vectors are of unit length, in a frame whose z is the normal.
#pragma once

#include "boxwood/render/warp.h"

namespace boxwood::render {

struct Ggx {
  float alpha;  ///< Roughness, above 0.

  /// The density of normals around `half`, per solid angle and projected area.
  float density(Vec3 half) const {
    const float x = half.x / alpha, y = half.y / alpha;
    const float stretched = x * x + y * y + half.z * half.z;
    return 1 / (kPi * alpha * alpha * stretched * stretched);
  }

  /// Smith's auxiliary function: hidden over visible area of the facets, seen from `w`.
  float lambda(Vec3 w) const {
    const float tan_squared = (w.x * w.x + w.y * w.y) / max(w.z * w.z, 1e-12f);
    return 0.5f * (std::sqrt(1 + alpha * alpha * tan_squared) - 1);
  }

  /// A normal that is visible from `outgoing`, which is above the surface.
  Vec3 sample_visible_normal(Vec3 outgoing, Vec2 u) const {
    // Stretch, so that the facets become a hemisphere; a uniform cap of the sphere, moved by the direction,
    // is what is seen.
    const Vec3 stretched = normalize(Vec3{alpha * outgoing.x, alpha * outgoing.y, outgoing.z});
    const float z = 1 - u.x * (1 + stretched.z);
    const float radius = std::sqrt(max(0.0f, 1 - z * z));
    const Vec2 turn = turn_sine_cosine(u.y);
    const Vec3 half = Vec3{radius * turn.y, radius * turn.x, z} + stretched;
    // The floor keeps the vector from vanishing where the facet is seen exactly edge-on.
    return normalize(Vec3{alpha * half.x, alpha * half.y, max(half.z, 1e-7f)});
  }

  /// The share of the facets seen from `outgoing`, above the surface, that `incoming` sees too; the two are
  /// on one side (their heights then go together) or on two.
  float masking(Vec3 outgoing, Vec3 incoming) const {
    const float first = lambda(outgoing), second = lambda(incoming);
    if (incoming.z > 0) return (1 + first) / (1 + first + second);
    return 1 / (1 + second);
  }

  /// The density, per solid angle, of the normal `half` among those visible from `outgoing`.
  float visible_density(Vec3 outgoing, Vec3 half) const {
    return density(half) * max(0.0f, dot(outgoing, half)) / (outgoing.z * (1 + lambda(outgoing)));
  }

  /// The BRDF times the incoming cosine, without the Fresnel factor.
  float reflection(Vec3 outgoing, Vec3 incoming, Vec3 half) const {
    return density(half) / (4 * outgoing.z * (1 + lambda(outgoing) + lambda(incoming)));
  }

  /// The density per solid angle of mirroring `outgoing` at a sampled normal `half`.
  float reflection_pdf(Vec3 outgoing, Vec3 half) const {
    return density(half) / (4 * outgoing.z * (1 + lambda(outgoing)));
  }
};

}  // namespace boxwood::render
