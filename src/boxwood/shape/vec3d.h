// vec3d.h: what is a vector in double?
//
// Where a shape squares or multiplies lengths, floats would overflow at 1e20 and vanish at 1e-20; in double
// the product of any six floats still fits. For the insides of functions, never in an interface.
#pragma once

#include "boxwood/core/vec.h"

namespace boxwood::detail {

struct Vec3d {
  double x = 0, y = 0, z = 0;
};

constexpr Vec3d widen(Vec3 a) {
  return {a.x, a.y, a.z};
}
constexpr Vec3 narrow(Vec3d a) {
  return {float(a.x), float(a.y), float(a.z)};
}

constexpr Vec3d operator+(Vec3d a, Vec3d b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3d operator-(Vec3d a, Vec3d b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3d operator*(Vec3d a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}
constexpr double dot(Vec3d a, Vec3d b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3d cross(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// At unit length; zero when `a` has no direction.
inline Vec3d unit(Vec3d a) {
  const double size = std::sqrt(dot(a, a));
  return size > 0 ? a * (1 / size) : Vec3d{};
}

/// The point of the segment from `a` to `b` that is nearest to `p`; the two may coincide.
inline Vec3d closest_on_segment(Vec3d p, Vec3d a, Vec3d b) {
  const Vec3d along = b - a;
  const double size2 = dot(along, along), s = dot(p - a, along);
  if (!(s > 0)) return a;
  return s >= size2 ? b : a + along * (s / size2);
}

}  // namespace boxwood::detail
