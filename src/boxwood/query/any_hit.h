// any_hit.h: does the ray hit anything at all?
//
// The question of a shadow ray. It has no best answer to wait for, so the first crossing ends the walk.
#pragma once

#include <span>

#include "boxwood/query/traverse.h"
#include "boxwood/shape/gate.h"

namespace boxwood {

/// The query (traverse.h) that stops at the first crossing it meets.
template <ShapeType Shape>
class AnyHitQuery {
 public:
  AnyHitQuery(const PreparedRay& ray, std::span<const Shape> shapes)
      : ray_(ray), shapes_(shapes), limit_(ray.t_max) {}

  float bound(const Box3& box) const { return ray_.bound(box); }
  BOXWOOD_ALWAYS_INLINE auto parts(const Box3& a, const Box3& b) const { return ray_.parts(a, b, limit()); }
  float limit() const { return limit_; }
  void visit(PrimId id) {
    if (!found()) intersect_gated(ray_, shapes_[id.value], *this);
  }
  bool found() const { return limit_ == -kInfinity; }

  // The query is its own sink: whatever comes in, nothing else matters any more.
  void report(const Crossing&) { limit_ = -kInfinity; }

 private:
  const PreparedRay& ray_;
  std::span<const Shape> shapes_;
  float limit_;
};

/// Whether there is a crossing with t in [ray.t_min, ray.t_max];
/// the same as closest_hit(...).is_hit(), sooner.
template <ShapeType Shape, class Statistics>
bool any_hit(const Bvh& bvh, std::span<const Shape> shapes, const Ray& ray, Statistics& statistics) {
  const PreparedRay prepared(ray, bvh.bounds());
  if (!prepared.is_valid()) return false;
  AnyHitQuery<Shape> query(prepared, shapes);
  traverse(bvh, query, statistics);
  return query.found();
}

template <class Shapes>
bool any_hit(const Bvh& bvh, const Shapes& shapes, const Ray& ray) {
  NoStatistics none;
  return any_hit(bvh, std::span(std::as_const(shapes)), ray, none);
}

}  // namespace boxwood
