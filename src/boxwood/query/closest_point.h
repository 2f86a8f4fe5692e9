// closest_point.h: which point of the shapes is nearest to a given one?
#pragma once

#include <span>

#include "boxwood/query/distance.h"
#include "boxwood/query/traverse.h"

namespace boxwood {

/// The query (traverse.h) for the nearest point: smallest distance, equal distance by smallest id.
template <class Shape>
requires ShapeType<Shape> && HasClosestPoint<Shape>
class ClosestPointQuery {
 public:
  ClosestPointQuery(Vec3 point, float max_distance, std::span<const Shape> shapes)
      : point_(point), shapes_(shapes), limit_(max_distance) {}

  float bound(const Box3& box) const { return distance(box, point_); }
  float limit() const { return limit_; }
  void visit(PrimId id) {
    const ShapePoint candidate = nearest_point_of(shapes_[id.value], id, point_);
    if (!(candidate.distance <= limit_) || !comes_before(candidate, best_)) return;
    best_ = candidate;
    limit_ = candidate.distance;
  }
  const ShapePoint& result() const { return best_; }

 private:
  Vec3 point_;
  std::span<const Shape> shapes_;
  float limit_;
  ShapePoint best_;
};

/// The nearest point within `max_distance` (included) of `point`, and its distance; none has distance = +inf.
/// A point that is not finite is near nothing. `bvh` was built over boxes(shapes), in the same order. Cost:
/// about log(n).
template <ShapeType Shape, class Statistics>
ShapePoint closest_point(const Bvh& bvh, std::span<const Shape> shapes, Vec3 point, float max_distance,
                         Statistics& statistics) {
  if (!is_finite(point)) return {};
  ClosestPointQuery<Shape> query(point, max_distance, shapes);
  traverse(bvh, query, statistics);
  return query.result();
}

template <class Shapes>
ShapePoint closest_point(const Bvh& bvh, const Shapes& shapes, Vec3 point, float max_distance = kInfinity) {
  NoStatistics none;
  return closest_point(bvh, std::span(std::as_const(shapes)), point, max_distance, none);
}

}  // namespace boxwood
