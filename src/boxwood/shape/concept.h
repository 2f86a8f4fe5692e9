// concept.h: what is a shape, and which laws does it obey?
//
// Trees know boxes and numbers only; queries meet shapes through this interface. A type of your own joins by
// having these members (or by deriving from Shape, shape.h, when one array is to hold different kinds).
#pragma once

#include <concepts>

#include "boxwood/core/hit.h"
#include "boxwood/core/prepared_ray.h"

namespace boxwood {

/// Takes what a shape reports.
template <class S>
concept CrossingSink = requires(S& sink, const Crossing& crossing) {
  { sink.limit() } -> std::same_as<float>;  // crossings above this t no longer matter; never grows
  {sink.report(crossing)};
};

/// A sink that ignores everything; stands in where a concept needs some sink.
struct NullSink {
  float limit() const { return kInfinity; }
  void report(const Crossing&) const {}
};

/// What rays can meet.
///
/// Laws (tests/shape holds every shape of this room to them):
///  1. box() gives the same bits at each call, and holds the shape;
///     it is empty when the shape can never be hit.
///  2. intersect() reports the crossings of the ray's whole *line*, each one once;
///     the query keeps those within [t_min, limit].
///     It may leave out crossings outside [ray.t_min, sink.limit()],
///     and must not leave out others.
///  3. It is a pure function of the shape and the ray: same bits in, same bits out. It never reports a NaN.
///  4. normal() is of unit length; closed shapes point it outward.
template <class S>
concept ShapeType = requires(const S& shape, const PreparedRay& ray, NullSink& sink,
                             const Crossing& crossing) {
  { shape.box() } -> std::same_as<Box3>;
  {shape.intersect(ray, sink)};
  { shape.normal(ray, crossing) } -> std::same_as<Vec3>;
};

/// A shape that also knows its point nearest to a given one (for closest point,
/// k nearest and overlap with a sphere).
template <class S>
concept HasClosestPoint = requires(const S& shape, Vec3 point) {
  { shape.closest_point(point) } -> std::same_as<Vec3>;
};

/// A shape that also knows whether it touches a box (for overlap with a box); touching counts. Surfaces are
/// hollow: a box wholly inside a sphere does not overlap its surface, but solid kinds say in their file that
/// they are solid.
template <class S>
concept HasOverlap = requires(const S& shape, const Box3& box) {
  { shape.overlaps(box) } -> std::same_as<bool>;
};

}  // namespace boxwood
