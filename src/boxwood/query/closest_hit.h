// closest_hit.h: what does the ray hit first?
#pragma once

#include <span>

#include "boxwood/query/traverse.h"
#include "boxwood/shape/gate.h"

namespace boxwood {

/// The query (traverse.h) for the first crossing: smallest t, equal t by smallest id.
template <ShapeType Shape>
class ClosestHitQuery {
 public:
  ClosestHitQuery(const PreparedRay& ray, std::span<const Shape> shapes)
      : ray_(ray), shapes_(shapes), limit_(ray.t_max) {}

  float bound(const Box3& box) const { return ray_.bound(box); }
  BOXWOOD_ALWAYS_INLINE auto parts(const Box3& a, const Box3& b) const { return ray_.parts(a, b, limit()); }
  float limit() const { return limit_; }
  void visit(PrimId id) {
    struct Sink {
      ClosestHitQuery& query;
      PrimId id;
      float limit() const { return query.limit_; }
      void report(const Crossing& crossing) { query.consider({crossing, id}); }
    } sink{*this, id};
    intersect_gated(ray_, shapes_[id.value], sink);
  }
  const ShapeHit& result() const { return best_; }

 private:
  void consider(const ShapeHit& hit) {
    if (!comes_before(hit, best_)) return;
    best_ = hit;
    limit_ = hit.t;
  }

  const PreparedRay& ray_;
  std::span<const Shape> shapes_;
  float limit_;
  ShapeHit best_;
};

/// The crossing with the smallest t in [ray.t_min, ray.t_max]; a miss has t = +inf. `bvh` was built over
/// boxes(shapes), in the same order. Cost: about log(n) on average; nothing is allocated or locked.
template <ShapeType Shape, class Statistics>
ShapeHit closest_hit(const Bvh& bvh, std::span<const Shape> shapes, const Ray& ray, Statistics& statistics) {
  const PreparedRay prepared(ray, bvh.bounds());
  if (!prepared.is_valid()) return {};
  ClosestHitQuery<Shape> query(prepared, shapes);
  traverse(bvh, query, statistics);
  return query.result();
}

template <class Shapes>
ShapeHit closest_hit(const Bvh& bvh, const Shapes& shapes, const Ray& ray) {
  NoStatistics none;
  return closest_hit(bvh, std::span(std::as_const(shapes)), ray, none);
}

}  // namespace boxwood
