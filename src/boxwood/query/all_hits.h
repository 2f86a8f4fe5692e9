// all_hits.h: what does the ray cross on its whole way?
//
// The limit never shrinks, so every box on the way is opened; each crossing comes once, because each shape
// stands in one leaf and reports each of its crossings once.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "boxwood/query/traverse.h"
#include "boxwood/shape/gate.h"

namespace boxwood {

/// The query (traverse.h) that keeps every crossing, in the order of the walk.
template <ShapeType Shape>
class AllHitsQuery {
 public:
  AllHitsQuery(const PreparedRay& ray, std::span<const Shape> shapes, std::vector<ShapeHit>& hits)
      : ray_(ray), shapes_(shapes), hits_(hits) {}

  float bound(const Box3& box) const { return ray_.bound(box); }
  BOXWOOD_ALWAYS_INLINE auto parts(const Box3& a, const Box3& b) const { return ray_.parts(a, b, limit()); }
  float limit() const { return ray_.t_max; }
  void visit(PrimId id) {
    struct Sink {
      AllHitsQuery& query;
      PrimId id;
      float limit() const { return query.ray_.t_max; }
      void report(const Crossing& crossing) { query.hits_.push_back({crossing, id}); }
    } sink{*this, id};
    intersect_gated(ray_, shapes_[id.value], sink);
  }

 private:
  const PreparedRay& ray_;
  std::span<const Shape> shapes_;
  std::vector<ShapeHit>& hits_;
};

/// Every crossing with t in [ray.t_min, ray.t_max], each once, sorted by comes_before. A closed surface gives
/// an even number from outside and an odd number from inside. Replaces what `hits` holds, and reuses its
/// memory.
template <ShapeType Shape, class Statistics>
void all_hits(const Bvh& bvh, std::span<const Shape> shapes, const Ray& ray, std::vector<ShapeHit>& hits,
              Statistics& statistics) {
  hits.clear();
  const PreparedRay prepared(ray, bvh.bounds());
  if (!prepared.is_valid()) return;
  AllHitsQuery<Shape> query(prepared, shapes, hits);
  traverse(bvh, query, statistics);
  std::sort(hits.begin(), hits.end(),
            [](const ShapeHit& a, const ShapeHit& b) { return comes_before(a, b); });
}

template <class Shapes>
void all_hits(const Bvh& bvh, const Shapes& shapes, const Ray& ray, std::vector<ShapeHit>& hits) {
  NoStatistics none;
  all_hits(bvh, std::span(std::as_const(shapes)), ray, hits, none);
}

template <class Shapes>
std::vector<ShapeHit> all_hits(const Bvh& bvh, const Shapes& shapes, const Ray& ray) {
  std::vector<ShapeHit> hits;
  all_hits(bvh, shapes, ray, hits);
  return hits;
}

}  // namespace boxwood
