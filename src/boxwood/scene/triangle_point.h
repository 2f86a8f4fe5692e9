// triangle_point.h: where on a triangle is a hit, and how far may that be from the truth?
//
// Error bounds follow Pharr, Jakob and Humphreys, Physically Based Rendering, 4th edition, section 6.8: a
// position made of rounded operations comes with a bound of what rounding did. To that we add what the leaf
// test itself may get wrong when it meets the same triangle again from so near. Selects in place of branches,
// for loops over many hits (surface_block.h).
#pragma once

#include <array>

#include "boxwood/shape/triangle.h"

namespace boxwood {

/// Half a unit in the last place of 1.
inline constexpr float kHalfUlp = 0x1p-24f;

/// What the corners hold, weighed by the weights `v` and `w` of the second and the third.
inline Vec3 blend(Vec3 a, Vec3 b, Vec3 c, float v, float w) {
  return a * (1 - v - w) + b * v + c * w;
}
inline Vec2 blend(Vec2 a, Vec2 b, Vec2 c, float v, float w) {
  return {a.x * (1 - v - w) + b.x * v + c.x * w, a.y * (1 - v - w) + b.y * v + c.y * w};
}
inline std::array<float, 4> blend(const std::array<float, 4>& a, const std::array<float, 4>& b,
                                  const std::array<float, 4>& c, float v, float w) {
  std::array<float, 4> out;
  for (std::size_t i = 0; i < 4; ++i) out[i] = a[i] * (1 - v - w) + b[i] * v + c[i] * w;
  return out;
}

/// How far from the plane of (a, b, c), near `p`, the watertight test could still report a crossing: its
/// vertices are moved by up to 7 half units of their distance, and its plane is tilted by the rounding of the
/// cross product, which matters for slivers.
inline float leaf_test_error(const Triangle& t, Vec3 p) {
  const float reach =
      std::sqrt(max(length_squared(t.a - p), max(length_squared(t.b - p), length_squared(t.c - p))));
  const Vec3 e1 = t.b - t.a, e2 = t.c - t.a;
  const float area_squared = length_squared(cross(e1, e2)),
              product_squared = length_squared(e1) * length_squared(e2);
  const float stretched = std::sqrt(min(product_squared / area_squared, 0x1p24f));
  const float sliver = area_squared > 0 ? stretched : 1.0f;
  return reach * (16 * kHalfUlp + 8 * kHalfUlp * sliver);
}

/// A position, and what it may be wrong by, component by component.
struct BoundedPoint {
  Vec3 position, error;
};

inline BoundedPoint point_of_triangle(const Triangle& t, float v, float w) {
  const float a_weight = 1 - v - w;
  const Vec3 position = t.a * a_weight + t.b * v + t.c * w;
  const Vec3 error = (abs(t.a * a_weight) + abs(t.b * v) + abs(t.c * w)) * (8 * kHalfUlp) +
                     splat(leaf_test_error(t, position));
  return {position, error};
}

/// How far along the unit vector `normal` a point has to be moved to leave its error box; twice that, for the
/// rounding of the new origin itself.
inline float clearance_of(Vec3 position, Vec3 error, Vec3 normal) {
  return 2 * (dot(abs(normal), error) + 2 * kHalfUlp * max_component(abs(position)));
}

/// The unit normal to shade by, of `blended` ones of the corners, on the side of `normal`; `normal` itself
/// where none are given, or they come to nothing.
inline Vec3 shading_normal_of(Vec3 blended, Vec3 normal, bool is_given) {
  // Anything that is not finite makes this sum so.
  const auto reach = [](Vec3 v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z); };
  const Vec3 unit = normalize(blended);
  const Vec3 turned = unit * (dot(unit, normal) < 0 ? -1.0f : 1.0f);
  const bool is_usable =
      is_given & (length_squared(blended) > 0) & (length_squared(turned) > 0) & (reach(turned) < kInfinity);
  return {is_usable ? turned.x : normal.x, is_usable ? turned.y : normal.y, is_usable ? turned.z : normal.z};
}

/// How much of uv, on a side, a square of side 1 covers where edges of a triangle lie so in space and in uv.
inline float uv_density_of(Vec3 first, Vec3 second, Vec2 first_uv, Vec2 second_uv) {
  const float uv_area = first_uv.x * second_uv.y - first_uv.y * second_uv.x;
  const float area = length(cross(first, second));
  const float density = std::sqrt(std::fabs(uv_area) / area);
  return area > 0 ? density : 0.0f;
}

}  // namespace boxwood
