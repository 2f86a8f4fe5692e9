// box.h: what is an axis-aligned box?
//
// Invariant: an empty box has lower = +inf and upper = -inf, so that the union with it changes nothing and no
// box test passes on it.
#pragma once

#include <limits>

#include "boxwood/core/vec.h"

namespace boxwood {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The axis-aligned box between two corners, both included. Default: the empty box.
struct Box3 {
  Vec3 lower{kInfinity, kInfinity, kInfinity};
  Vec3 upper{-kInfinity, -kInfinity, -kInfinity};

  constexpr void extend(Vec3 p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  constexpr void extend(const Box3& other) {
    lower = min(lower, other.lower);
    upper = max(upper, other.upper);
  }
  constexpr bool is_empty() const {
    return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z);
  }
  constexpr Vec3 extent() const { return upper - lower; }
  /// The middle; halves are added, so that it stays finite for every finite box.
  constexpr Vec3 center() const { return lower * 0.5f + upper * 0.5f; }
  constexpr Vec3 corner(int which) const {  // bit k of `which` picks lower or upper on axis k
    return {which & 1 ? upper.x : lower.x, which & 2 ? upper.y : lower.y, which & 4 ? upper.z : lower.z};
  }
  constexpr bool contains(Vec3 p) const {
    return lower.x <= p.x && p.x <= upper.x && lower.y <= p.y && p.y <= upper.y && lower.z <= p.z &&
           p.z <= upper.z;
  }
  constexpr bool contains(const Box3& b) const {
    return b.is_empty() || (contains(b.lower) && contains(b.upper));
  }
  constexpr bool overlaps(const Box3& b) const {  // touching counts
    return lower.x <= b.upper.x && b.lower.x <= upper.x && lower.y <= b.upper.y && b.lower.y <= upper.y &&
           lower.z <= b.upper.z && b.lower.z <= upper.z;
  }
  friend constexpr bool operator==(const Box3&, const Box3&) = default;
};

constexpr Box3 unite(Box3 a, const Box3& b) {
  a.extend(b);
  return a;
}

constexpr Box3 intersect(const Box3& a, const Box3& b) {
  return {max(a.lower, b.lower), min(a.upper, b.upper)};
}

/// Half of the surface: the measure that the surface area heuristic compares. 0 for an empty box. In double,
/// because the product of two large extents overflows a float.
constexpr double half_area(const Box3& box) {
  if (box.is_empty()) return 0;
  const double x = double(box.upper.x) - box.lower.x, y = double(box.upper.y) - box.lower.y,
               z = double(box.upper.z) - box.lower.z;
  return x * y + y * z + z * x;
}

}  // namespace boxwood
