// affine.h: how does a thing stand in the world?
//
// Named after what it does, target first: `world_from_object` maps object coordinates to world coordinates,
// and `world_from_object * object_from_part` reads as it works.
#pragma once

#include "boxwood/core/box.h"

namespace boxwood {

/// An affine map: p -> x*p.x + y*p.y + z*p.z + origin.
/// Columns, so `x` is where the first axis goes. Default: identity.
struct Affine3 {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Vec3 origin{0, 0, 0};

  static constexpr Affine3 identity() { return {}; }
  static constexpr Affine3 translation(Vec3 by) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, by}; }
  static constexpr Affine3 scale(Vec3 by) { return {{by.x, 0, 0}, {0, by.y, 0}, {0, 0, by.z}, {}}; }
  static constexpr Affine3 scale(float by) { return scale(splat(by)); }
  /// Turns by `angle_deg` about `axis` (any length but 0), counter-clockwise as seen against the axis.
  static Affine3 rotation(Vec3 axis, float angle_deg);
  /// world_from_camera: stands at `eye`, looks along -z at `target`, +y close to `up`, +x to the right.
  static Affine3 look_at(Vec3 eye, Vec3 target, Vec3 up);

  constexpr Vec3 point(Vec3 p) const { return x * p.x + y * p.y + z * p.z + origin; }
  constexpr Vec3 vector(Vec3 v) const { return x * v.x + y * v.y + z * v.z; }
  friend constexpr bool operator==(const Affine3&, const Affine3&) = default;
};

constexpr Affine3 operator*(const Affine3& a, const Affine3& b) {
  return {a.vector(b.x), a.vector(b.y), a.vector(b.z), a.point(b.origin)};
}

/// The determinant of the linear part; 0 where the map flattens space, negative where it mirrors.
double determinant(const Affine3& m);

/// The inverse, computed in double.
/// Throws std::invalid_argument when the map is not finite or cannot be inverted.
Affine3 inverse(const Affine3& m);

/// Maps a normal (a covector): multiplies by the transpose
/// of the linear part of `object_from_world`. Not normalized.
constexpr Vec3 transform_normal(const Affine3& object_from_world, Vec3 n) {
  return {dot(object_from_world.x, n), dot(object_from_world.y, n), dot(object_from_world.z, n)};
}

/// A box that holds the image of every point of `box`, whatever the rounding. Empty stays empty.
Box3 transform_box(const Affine3& m, const Box3& box);

}  // namespace boxwood
