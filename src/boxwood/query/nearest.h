// nearest.h: which k shapes are nearest to a point?
//
// The k best so far stand in a heap with the worst on top; once there are k, nothing beyond that one matters.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "boxwood/query/distance.h"
#include "boxwood/query/traverse.h"

namespace boxwood {

/// The query (traverse.h) for the k nearest shapes.
template <class Shape>
requires ShapeType<Shape> && HasClosestPoint<Shape>
class NearestQuery {
 public:
  NearestQuery(Vec3 point, std::size_t k, float max_distance, std::span<const Shape> shapes)
      : point_(point), k_(k), limit_(k > 0 ? max_distance : -kInfinity), shapes_(shapes) {
    heap_.reserve(std::min(k, shapes.size()));
  }

  float bound(const Box3& box) const { return distance(box, point_); }
  float limit() const { return limit_; }
  void visit(PrimId id) {
    const ShapePoint candidate = nearest_point_of(shapes_[id.value], id, point_);
    if (!(candidate.distance <= limit_) || !candidate.is_found()) return;

    // Make room by dropping the worst, unless the candidate is worse still.
    if (heap_.size() == k_) {
      if (!comes_before(candidate, heap_.front())) return;
      std::pop_heap(heap_.begin(), heap_.end(), kOrder);
      heap_.pop_back();
    }
    heap_.push_back(candidate);
    std::push_heap(heap_.begin(), heap_.end(), kOrder);
    if (heap_.size() == k_) limit_ = heap_.front().distance;
  }
  /// Nearest first; leaves the query empty.
  std::vector<ShapePoint> take_result() {
    std::sort_heap(heap_.begin(), heap_.end(), kOrder);
    return std::move(heap_);
  }

 private:
  static constexpr auto kOrder = [](const ShapePoint& a, const ShapePoint& b) { return comes_before(a, b); };

  Vec3 point_;
  std::size_t k_;
  float limit_;
  std::span<const Shape> shapes_;
  std::vector<ShapePoint> heap_;
};

/// The `k` shapes nearest to `point` and no farther than `max_distance`, each with its nearest point, sorted
/// by distance and then by id; fewer when there are fewer. A point that is not finite is near nothing.
template <ShapeType Shape, class Statistics>
std::vector<ShapePoint> nearest(const Bvh& bvh, std::span<const Shape> shapes, Vec3 point, std::size_t k,
                                float max_distance, Statistics& statistics) {
  if (!is_finite(point)) return {};
  NearestQuery<Shape> query(point, k, max_distance, shapes);
  traverse(bvh, query, statistics);
  return query.take_result();
}

template <class Shapes>
std::vector<ShapePoint> nearest(const Bvh& bvh, const Shapes& shapes, Vec3 point, std::size_t k,
                                float max_distance = kInfinity) {
  NoStatistics none;
  return nearest(bvh, std::span(std::as_const(shapes)), point, k, max_distance, none);
}

}  // namespace boxwood
