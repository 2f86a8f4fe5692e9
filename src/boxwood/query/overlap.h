// overlap.h: which shapes touch a region?
//
// A region is a box or a ball, both solid. A shape counts only when its own box touches the region too, so
// that the rounding of the shape's test can never find more than the tree lets through.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "boxwood/query/distance.h"
#include "boxwood/query/traverse.h"

namespace boxwood {

/// The query (traverse.h) for the shapes that touch a box.
template <class Shape>
requires ShapeType<Shape> && HasOverlap<Shape>
class BoxOverlapQuery {
 public:
  BoxOverlapQuery(const Box3& region, std::span<const Shape> shapes) : region_(region), shapes_(shapes) {}

  float bound(const Box3& box) const { return box.overlaps(region_) ? 0.0f : kInfinity; }
  float limit() const { return 0; }
  void visit(PrimId id) {
    const Shape& shape = shapes_[id.value];
    if (shape.box().overlaps(region_) && shape.overlaps(region_)) found_.push_back(id);
  }
  /// Sorted; leaves the query empty.
  std::vector<PrimId> take_result() {
    std::sort(found_.begin(), found_.end());
    return std::move(found_);
  }

 private:
  Box3 region_;
  std::span<const Shape> shapes_;
  std::vector<PrimId> found_;
};

/// The query (traverse.h) for the shapes that reach into a ball.
template <class Shape>
requires ShapeType<Shape> && HasClosestPoint<Shape>
class BallOverlapQuery {
 public:
  BallOverlapQuery(Vec3 center, float radius, std::span<const Shape> shapes)
      : center_(center), radius_(radius), shapes_(shapes) {}

  float bound(const Box3& box) const { return distance(box, center_); }
  float limit() const { return radius_; }
  void visit(PrimId id) {
    const ShapePoint nearest = nearest_point_of(shapes_[id.value], id, center_);
    if (nearest.is_found() && nearest.distance <= radius_) found_.push_back(id);
  }
  /// Sorted; leaves the query empty.
  std::vector<PrimId> take_result() {
    std::sort(found_.begin(), found_.end());
    return std::move(found_);
  }

 private:
  Vec3 center_;
  float radius_;
  std::span<const Shape> shapes_;
  std::vector<PrimId> found_;
};

/// The ids, sorted, of all shapes that touch `region`. Surfaces are hollow, so a box wholly inside a sphere
/// does not touch it. An empty region, or one with a NaN, touches nothing.
template <ShapeType Shape, class Statistics>
std::vector<PrimId> overlap(const Bvh& bvh, std::span<const Shape> shapes, const Box3& region,
                            Statistics& statistics) {
  if (region.is_empty()) return {};
  BoxOverlapQuery<Shape> query(region, shapes);
  traverse(bvh, query, statistics);
  return query.take_result();
}

template <class Shapes>
std::vector<PrimId> overlap(const Bvh& bvh, const Shapes& shapes, const Box3& region) {
  NoStatistics none;
  return overlap(bvh, std::span(std::as_const(shapes)), region, none);
}

/// The ids, sorted, of all shapes with a point no farther than `radius` from `center`. A center that is not
/// finite, or a radius that is negative or NaN, touches nothing.
template <ShapeType Shape, class Statistics>
std::vector<PrimId> overlap(const Bvh& bvh, std::span<const Shape> shapes, Vec3 center, float radius,
                            Statistics& statistics) {
  if (!is_finite(center)) return {};
  BallOverlapQuery<Shape> query(center, radius, shapes);
  traverse(bvh, query, statistics);
  return query.take_result();
}

template <class Shapes>
std::vector<PrimId> overlap(const Bvh& bvh, const Shapes& shapes, Vec3 center, float radius) {
  NoStatistics none;
  return overlap(bvh, std::span(std::as_const(shapes)), center, radius, none);
}

}  // namespace boxwood
