// fresnel.h: which share of the light does a boundary reflect?
#pragma once

#include "boxwood/core/vec.h"

namespace boxwood::render {

/// The share, of unpolarized light, that the smooth boundary of a dielectric reflects. `cosine`, in [0, 1],
/// is that of the angle to the normal on the side the light is on; `eta` is the index of refraction of the
/// other side over that of this side. 1 under total internal reflection.
inline float fresnel_dielectric(float cosine, float eta) {
  const float sine_squared = (1 - cosine * cosine) / (eta * eta);  // on the other side, by Snell's law
  const float other_cosine = std::sqrt(max(0.0f, 1 - sine_squared));
  const float parallel = (eta * cosine - other_cosine) / (eta * cosine + other_cosine);
  const float perpendicular = (cosine - eta * other_cosine) / (cosine + eta * other_cosine);
  const float reflected = 0.5f * (parallel * parallel + perpendicular * perpendicular);
  return sine_squared >= 1 ? 1.0f : reflected;
}

/// The share that a metal reflects whose color, seen head-on, is `color`. Schlick, "An Inexpensive BRDF Model
/// for Physically-based Rendering", 1994.
inline Vec3 fresnel_metal(float cosine, Vec3 color) {
  const float x = max(0.0f, 1 - cosine), x2 = x * x;
  return color + (splat(1) - color) * (x2 * x2 * x);
}

/// The share that a metal with the complex index of refraction eta + ik reflects of unpolarized light.
inline float fresnel_conductor(float cosine, float eta, float k) {
  // Born and Wolf, Principles of Optics, 14.2: by the real and the imaginary part of eta cos' on the far
  // side.
  const float cos2 = cosine * cosine, sin2 = 1 - cos2;
  const float base = eta * eta - k * k - sin2;
  const float a2_b2 = std::sqrt(base * base + 4 * eta * eta * k * k);
  const float a = std::sqrt(max(0.0f, 0.5f * (a2_b2 + base)));
  const float perpendicular = (a2_b2 + cos2 - 2 * a * cosine) / (a2_b2 + cos2 + 2 * a * cosine);
  const float parallel = perpendicular * (cos2 * a2_b2 + sin2 * sin2 - 2 * a * cosine * sin2) /
                         (cos2 * a2_b2 + sin2 * sin2 + 2 * a * cosine * sin2);
  return 0.5f * (perpendicular + parallel);
}

/// Snell's law: the direction on the other side of a boundary with the normal `normal`, for the direction
/// `outgoing` on its side; `eta` is the index of refraction of this side over the other. Precondition: there
/// is no total reflection.
inline Vec3 refract(Vec3 outgoing, Vec3 normal, float eta) {
  const float cosine = dot(outgoing, normal);
  const float other_cosine = std::sqrt(max(0.0f, 1 - eta * eta * (1 - cosine * cosine)));
  return normalize(normal * (eta * cosine - other_cosine) - outgoing * eta);
}

/// The share that the boundary reflects of light that comes from all directions of the *dense* side alike.
/// Worked out from the outer side, where the integral is smooth, by the reciprocity (1 - inner) eta^2 = 1 -
/// outer.
inline float internal_diffuse_reflectance(float eta) {
  constexpr int kSteps = 256;
  double passed = 0;  // midpoint rule for the integral of (1 - F) d(sin^2)
  for (int i = 0; i < kSteps; ++i) {
    const float sine_squared = (static_cast<float>(i) + 0.5f) / kSteps;
    passed += 1 - fresnel_dielectric(std::sqrt(1 - sine_squared), eta);
  }
  return static_cast<float>(1 - passed / kSteps / (double(eta) * eta));
}

}  // namespace boxwood::render
