// gate.h: why may a tree cull by boxes, whatever the rounding of a shape?
//
// Because a crossing counts only at a t inside the (widened) interval of its own shape's box. A t that
// rounding has put outside is moved to the interval's end; where the interval is empty there is no crossing.
// Box intervals are monotonic (core/prepared_ray.h), so every box around the shape contains that t, and no
// culling can lose it. Brute force applies the same rule, and so do all the rival structures: hence *equal*,
// for every shape, also a user's own.
//
// A tree with spatial splits needs more. There a leaf's box holds a part of a triangle, the interval that
// counts is still the whole triangle's, and t might lie in the latter but beyond the former. With u and R as
// in core/prepared_ray.h:
//
//  - The triangle test (shape/triangle.h) accepts a line only when it passes within 7uR, along each axis, of
//    a point P of the triangle; and t, in units of depth, is off the depth of P by no more than E uR, where E
//    = 24 / kEdgeOn + 3 = 771. Along no axis does the line go faster than along its longest, so its point at
//    t is within (E + 7) uR of P.
//  - Moving t into the interval of the whole triangle's box moves it towards P, or, where rounding makes the
//    interval end before P, by less than the slack of that end, 12uR.
//  - Some part's box holds P. Widened by (E + 19) uR, and 4uR + 4u|o| for the rounding of the interval
//  itself,
//    it holds the line's point at t. 68 times the slack of the slabs suffices; with kPartSlack times, t lies
//    in that leaf's interval and in those of all boxes around it, so no culling can lose the crossing.
//
// That slack is about 2^-14 of the reach; boxes of whole triangles do not need it.
#pragma once

#include "boxwood/shape/concept.h"

namespace boxwood {

/// How many times the slack of its slabs a ray needs for boxes of parts.
inline constexpr float kPartSlack = 72;

/// Stands between a shape and the query's sink: moves each crossing into the interval of the shape's box and
/// passes on those within [t_min, limit]. The limit that the shape sees is corrected for the move, so that an
/// instance can cull.
template <CrossingSink Sink>
class BoxGate {
 public:
  BoxGate(const PreparedRay& ray, const Interval& interval, Sink& sink)
      : sink_(sink), interval_(interval), t_min_(ray.t_min) {}

  float limit() const {
    const float outer = sink_.limit();
    if (interval_.is_empty() || outer < interval_.entry) return -kInfinity;
    return outer >= interval_.exit ? kInfinity : outer;
  }

  void report(Crossing crossing) {
    if (interval_.is_empty()) return;
    crossing.t = min(max(crossing.t, interval_.entry), interval_.exit) + 0.0f;
    if (crossing.t >= t_min_ && crossing.t <= sink_.limit()) sink_.report(crossing);
  }

 private:
  Sink& sink_;
  Interval interval_;
  float t_min_;
};

/// The t_min that a ray inside an instance must be prepared with:
/// -inf when every crossing is moved past ours.
inline float inner_t_min(const PreparedRay& ray, const Interval& interval) {
  return interval.entry >= ray.t_min ? -kInfinity : ray.t_min;
}

/// A gate that works out the interval when it is first needed; most shapes report nothing and never need it.
template <class Shape, CrossingSink Sink>
class LazyBoxGate {
 public:
  LazyBoxGate(const PreparedRay& ray, const Shape& shape, Sink& sink)
      : ray_(ray), shape_(shape), sink_(sink) {}
  float limit() { return gate().limit(); }
  void report(const Crossing& crossing) { gate().report(crossing); }

 private:
  BoxGate<Sink> gate() {
    if (!is_known_) {
      interval_ = ray_.interval(shape_.box());
      is_known_ = true;
    }
    return {ray_, interval_, sink_};
  }

  const PreparedRay& ray_;
  const Shape& shape_;
  Sink& sink_;
  Interval interval_{};
  bool is_known_ = false;
};

/// Intersects one shape under the rule above. Everything in the library that meets a shape goes through here.
template <ShapeType Shape, CrossingSink Sink>
void intersect_gated(const PreparedRay& ray, const Shape& shape, Sink& sink) {
  LazyBoxGate<Shape, Sink> gate(ray, shape, sink);
  shape.intersect(ray, gate);
}

}  // namespace boxwood
