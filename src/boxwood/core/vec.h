// vec.h: what is a point, a direction, a color?
//
// One plain struct of three floats serves for all of them; the name of the variable says which it is. Every
// function is a few IEEE operations in a fixed order, because the contract promises the same bits everywhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace boxwood {

/// Two floats: a surface parameter (u, v), or a point on the picture.
struct Vec2 {
  float x = 0, y = 0;
  friend bool operator==(const Vec2&, const Vec2&) = default;
};

/// Three floats: a point, a direction or a linear RGB color.
struct Vec3 {
  float x = 0, y = 0, z = 0;

  constexpr float operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr float& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

constexpr Vec3 splat(float s) {
  return {s, s, s};
}

constexpr Vec3 operator-(Vec3 a) {
  return {-a.x, -a.y, -a.z};
}
constexpr Vec3 operator+(Vec3 a, Vec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3 operator-(Vec3 a, Vec3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3 operator*(Vec3 a, Vec3 b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
constexpr Vec3 operator/(Vec3 a, Vec3 b) {
  return {a.x / b.x, a.y / b.y, a.z / b.z};
}
constexpr Vec3 operator*(Vec3 a, float s) {
  return {a.x * s, a.y * s, a.z * s};
}
constexpr Vec3 operator*(float s, Vec3 a) {
  return a * s;
}
constexpr Vec3 operator/(Vec3 a, float s) {
  return {a.x / s, a.y / s, a.z / s};
}
constexpr Vec3& operator+=(Vec3& a, Vec3 b) {
  return a = a + b;
}
constexpr Vec3& operator-=(Vec3& a, Vec3 b) {
  return a = a - b;
}
constexpr Vec3& operator*=(Vec3& a, Vec3 b) {
  return a = a * b;
}
constexpr Vec3& operator*=(Vec3& a, float s) {
  return a = a * s;
}

constexpr float dot(Vec3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr float length_squared(Vec3 a) {
  return dot(a, a);
}
inline float length(Vec3 a) {
  return std::sqrt(dot(a, a));
}
/// The unit vector along `a`; NaN where `a` has no direction.
inline Vec3 normalize(Vec3 a) {
  return a / length(a);
}

// Written as selects, so that the result is defined for NaN and -0 too: `b` unless `a` is strictly better.
constexpr float min(float a, float b) {
  return a < b ? a : b;
}
constexpr float max(float a, float b) {
  return a > b ? a : b;
}
constexpr Vec3 min(Vec3 a, Vec3 b) {
  return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
constexpr Vec3 max(Vec3 a, Vec3 b) {
  return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}
constexpr float max_component(Vec3 a) {
  return max(a.x, max(a.y, a.z));
}
constexpr float min_component(Vec3 a) {
  return min(a.x, min(a.y, a.z));
}
inline Vec3 abs(Vec3 a) {
  return {std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)};
}
inline bool is_finite(Vec3 a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
/// 0, 1 or 2: the axis of the largest component; the first one when equal.
constexpr int longest_axis(Vec3 a) {
  // Without a branch: on directions of rays it would be hard to foresee.
  const int is_z = (a.z > a.x) & (a.z > a.y), is_y = a.y > a.x;
  return is_z << 1 | (is_y & ~is_z);
}

/// Two unit vectors that form a right-handed orthonormal basis with the unit vector `n`.
/// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017.
inline void orthonormal_basis(Vec3 n, Vec3& tangent, Vec3& bitangent) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z);
  const float b = n.x * n.y * a;
  tangent = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
  bitangent = {b, sign + n.y * n.y * a, -n.y};
}

}  // namespace boxwood
