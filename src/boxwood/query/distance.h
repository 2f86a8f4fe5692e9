// distance.h: how far is a point from a box and from a shape?
//
// Distances are worked out in double and rounded once, so that neither 1e30 nor 1e-30 spoils them. Every step
// rounds monotonically: a box is never farther than a box inside it. A shape is by the same rule never nearer
// than its own box (compare shape/gate.h), so no box around it can be culled wrongly and the answer does not
// depend on the tree.
#pragma once

#include "boxwood/shape/concept.h"

namespace boxwood {

/// A point of a shape of a span, and its distance from the point that was asked about.
/// None: distance = +inf, no id.
struct ShapePoint {
  float distance = kInfinity;
  Vec3 position;
  PrimId prim_id;

  bool is_found() const { return distance < kInfinity; }
  friend bool operator==(const ShapePoint&, const ShapePoint&) = default;
};

/// Nearer first, equal distance by id: a total order over the shapes.
inline bool comes_before(const ShapePoint& a, const ShapePoint& b) {
  return a.distance != b.distance ? a.distance < b.distance : a.prim_id < b.prim_id;
}

inline float distance(Vec3 a, Vec3 b) {
  const double x = double(a.x) - b.x, y = double(a.y) - b.y, z = double(a.z) - b.z;
  return static_cast<float>(std::sqrt(x * x + y * y + z * z));
}

/// 0 inside; +inf for an empty box. Law: at most the distance of any box inside it.
inline float distance(const Box3& box, Vec3 p) {
  const auto outside = [](double lower, double upper, double c) {
    return std::max({lower - c, c - upper, 0.0});
  };
  const double x = outside(box.lower.x, box.upper.x, p.x);
  const double y = outside(box.lower.y, box.upper.y, p.y);
  const double z = outside(box.lower.z, box.upper.z, p.z);
  return static_cast<float>(std::sqrt(x * x + y * y + z * z));
}

/// The point of one shape that is nearest to `p`; none when the shape's box is empty.
template <class Shape>
requires ShapeType<Shape> && HasClosestPoint<Shape> ShapePoint nearest_point_of(const Shape& shape, PrimId id,
                                                                                Vec3 p) {
  const float least = distance(shape.box(), p);
  if (!(least < kInfinity)) return {};
  const Vec3 position = shape.closest_point(p);
  return {max(distance(position, p), least), position, id};
}

}  // namespace boxwood
