// hit.h: what is answered?
//
// Three answers, from the lowest floor to the highest. A Crossing is what a shape says of itself; a ShapeHit
// adds which shape of a span it was; a Hit (scene) adds the instance and the geometry.
#pragma once

#include "boxwood/core/box.h"
#include "boxwood/core/id.h"

namespace boxwood {

/// One point where the line of a ray meets a surface.
struct Crossing {
  float t = kInfinity;     ///< In multiples of the ray's direction.
  float u = 0, v = 0;      ///< Surface parameters; for a triangle the weights of its second and third vertex.
  std::uint32_t part = 0;  ///< Which face, side or inner primitive; each shape's file says which.

  bool is_hit() const { return t < kInfinity; }
  friend bool operator==(const Crossing&, const Crossing&) = default;
};

/// A crossing and the shape of the span that it is on. A miss has t = +inf and no id.
struct ShapeHit : Crossing {
  PrimId prim_id;

  friend bool operator==(const ShapeHit&, const ShapeHit&) = default;
};

/// The order of the contract: smaller t first, equal t by id, then by what is left (shapes in nested groups
/// may share the part). A total order, so "the closest" is unique.
inline bool comes_before(const ShapeHit& a, const ShapeHit& b) {
  if (a.t != b.t) return a.t < b.t;
  if (a.prim_id != b.prim_id) return a.prim_id < b.prim_id;
  if (a.part != b.part) return a.part < b.part;
  return a.u != b.u ? a.u < b.u : a.v < b.v;
}

/// What a ray hits in a scene. A miss has t = +inf, no ids, and a zero normal.
struct Hit {
  float t = kInfinity;  ///< In multiples of the ray's direction.
  float u = 0, v = 0;   ///< As in Crossing.
  Vec3 normal;          ///< Geometric, in world space, of unit length, outward or by the triangle's winding.
  InstanceId instance_id;
  GeometryId geometry_id;
  PrimId primitive_id;
  std::uint32_t part = 0;  ///< As in Crossing.

  bool is_hit() const { return t < kInfinity; }
  explicit operator bool() const { return is_hit(); }
  friend bool operator==(const Hit&, const Hit&) = default;
};

/// The order of the contract: smaller t first,
/// equal t by (instance, geometry, primitive), then by what is left.
inline bool comes_before(const Hit& a, const Hit& b) {
  if (a.t != b.t) return a.t < b.t;
  if (a.instance_id != b.instance_id) return a.instance_id < b.instance_id;
  if (a.geometry_id != b.geometry_id) return a.geometry_id < b.geometry_id;
  if (a.primitive_id != b.primitive_id) return a.primitive_id < b.primitive_id;
  if (a.part != b.part) return a.part < b.part;
  return a.u != b.u ? a.u < b.u : a.v < b.v;
}

}  // namespace boxwood
