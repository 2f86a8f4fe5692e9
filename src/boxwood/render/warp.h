// warp.h: how does a uniform point of the unit square become a point on something else?
//
// Each map keeps areas in proportion, so that well spread samples stay well spread.
// Densities stand beside the maps.
#pragma once

#include "boxwood/core/vec.h"

namespace boxwood::render {

inline constexpr float kPi = 3.14159265358979f;

/// The sine and cosine of an angle of at most pi / 4 either way, to within a unit or two in the last place.
/// The series of Taylor, as long as the last place asks for: an answer in a dozen operations, and the same
/// with every C library.
inline Vec2 small_sine_cosine(float angle) {
  const float x2 = angle * angle;
  const float sine =
      angle + angle * x2 * (-1 / 6.0f + x2 * (1 / 120.0f + x2 * (-1 / 5040.0f + x2 * (1 / 362880.0f))));
  const float cosine = 1 + x2 * (-0.5f + x2 * (1 / 24.0f + x2 * (-1 / 720.0f + x2 * (1 / 40320.0f))));
  return {sine, cosine};
}

/// The sine and cosine of a share of a full turn, in [0, 1]: of what is left beside the nearest quarter, with
/// the two exchanged and turned as that asks. Selects in place of branches, for loops over many.
inline Vec2 turn_sine_cosine(float turn) {
  const int quarter = static_cast<int>(4 * turn + 0.5f);
  const Vec2 small = small_sine_cosine(2 * kPi * (turn - 0.25f * static_cast<float>(quarter)));
  const float sine = (quarter & 1) != 0 ? small.y : small.x, cosine = (quarter & 1) != 0 ? small.x : small.y;
  return {(quarter & 2) != 0 ? -sine : sine, ((quarter + 1) & 2) != 0 ? -cosine : cosine};
}

/// Uniform on the unit disk. Shirley and Chiu, "A Low Distortion Map Between Disk and Square", JGT 1997.
inline Vec2 uniform_disk(Vec2 u) {
  const float a = 2 * u.x - 1, b = 2 * u.y - 1;
  const bool is_wide = std::fabs(a) > std::fabs(b);
  const float radius = is_wide ? a : b;
  const float slope = radius != 0 ? (is_wide ? b : a) / radius : 0.0f;
  const Vec2 turn = small_sine_cosine((kPi / 4) * slope);
  return is_wide ? Vec2{radius * turn.y, radius * turn.x} : Vec2{radius * turn.x, radius * turn.y};
}

/// On the hemisphere around +z with density cos / pi.
inline Vec3 cosine_hemisphere(Vec2 u) {
  const Vec2 d = uniform_disk(u);
  return {d.x, d.y, std::sqrt(max(0.0f, 1 - d.x * d.x - d.y * d.y))};
}

/// Uniform, with density 1 / (2 pi (1 - cos_angle)), on the directions within an angle of +z. `versine` is 1
/// - cos_angle: 1 for the hemisphere, 2 for the sphere, and exact for cones as narrow as the sun's.
inline Vec3 uniform_cone(Vec2 u, float versine) {
  const float below_top = u.x * versine;
  const float radius = std::sqrt(max(0.0f, below_top * (2 - below_top)));
  const Vec2 turn = turn_sine_cosine(u.y);
  return {radius * turn.y, radius * turn.x, 1 - below_top};
}

/// The weights of the second and third vertex of a triangle, uniform over its area. Heitz, "A Low-Distortion
/// Map Between Triangle and Square", 2019.
inline Vec2 uniform_triangle(Vec2 u) {
  if (u.y > u.x) {
    const float x = 0.5f * u.x;
    return {x, u.y - x};
  }
  const float y = 0.5f * u.y;
  return {u.x - y, y};
}

/// From -1 to 1 with a density that falls off linearly from 0: a tent.
inline float tent(float u) {
  return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u);
}

/// Three unit vectors at right angles; z is the one that matters.
struct Frame {
  Vec3 x, y, z;

  explicit Frame(Vec3 unit_z) : z(unit_z) { orthonormal_basis(z, x, y); }
  Vec3 to_world(Vec3 local) const { return x * local.x + y * local.y + z * local.z; }
  Vec3 to_local(Vec3 world) const { return {dot(x, world), dot(y, world), dot(z, world)}; }
};

}  // namespace boxwood::render
