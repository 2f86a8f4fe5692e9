// brute_force.h: what is the answer when every shape is looked at?
//
// The judge of every structure here: no tree, no bound, no limit that shrinks. It looks at each shape for
// each question and takes the best of all candidates at the end. The contract asks the others to be *equal*
// to it, so it applies the same two rules to a single shape: shape/gate.h for crossings, query/distance.h for
// distances.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "boxwood/query/distance.h"
#include "boxwood/shape/gate.h"

namespace boxwood::reference {

/// Answers the queries of query/ over a span of shapes, which must outlive it.
/// Cost: n shapes for each question.
template <ShapeType Shape>
class BruteForce {
 public:
  explicit BruteForce(std::span<const Shape> shapes) : shapes_(shapes) {
    for (const Shape& shape : shapes) bounds_.extend(shape.box());
  }

  ShapeHit closest_hit(const Ray& ray) const {
    ShapeHit best;
    for_each_crossing(ray, [&](const ShapeHit& hit) {
      if (comes_before(hit, best)) best = hit;
    });
    return best;
  }

  bool any_hit(const Ray& ray) const {
    bool found = false;
    for_each_crossing(ray, [&](const ShapeHit&) { found = true; });
    return found;
  }

  void all_hits(const Ray& ray, std::vector<ShapeHit>& hits) const {
    hits.clear();
    for_each_crossing(ray, [&](const ShapeHit& hit) { hits.push_back(hit); });
    std::sort(hits.begin(), hits.end(),
              [](const ShapeHit& a, const ShapeHit& b) { return comes_before(a, b); });
  }

  ShapePoint closest_point(Vec3 point, float max_distance = kInfinity) const {
    const std::vector<ShapePoint> best = nearest(point, 1, max_distance);
    return best.empty() ? ShapePoint{} : best.front();
  }

  std::vector<ShapePoint> nearest(Vec3 point, std::size_t k, float max_distance = kInfinity) const {
    std::vector<ShapePoint> points;
    if (!is_finite(point)) return points;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      const ShapePoint candidate = nearest_point_of(shapes_[i], PrimId(i), point);
      if (candidate.is_found() && candidate.distance <= max_distance) points.push_back(candidate);
    }
    std::sort(points.begin(), points.end(),
              [](const ShapePoint& a, const ShapePoint& b) { return comes_before(a, b); });
    points.resize(std::min(k, points.size()));
    return points;
  }

  std::vector<PrimId> overlap(const Box3& region) const {
    std::vector<PrimId> found;
    for (std::size_t i = 0; i < shapes_.size(); ++i)
      if (shapes_[i].box().overlaps(region) && shapes_[i].overlaps(region)) found.push_back(PrimId(i));
    return found;
  }

  std::vector<PrimId> overlap(Vec3 center, float radius) const {
    std::vector<PrimId> found;
    if (!is_finite(center)) return found;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      const ShapePoint nearest = nearest_point_of(shapes_[i], PrimId(i), center);
      if (nearest.is_found() && nearest.distance <= radius) found.push_back(PrimId(i));
    }
    return found;
  }

  const Box3& bounds() const { return bounds_; }
  std::size_t size_bytes() const { return 0; }  ///< Beyond the shapes themselves.

 private:
  template <class Visit>
  void for_each_crossing(const Ray& ray, const Visit& visit) const {
    struct Sink {
      const Visit& visit;
      float t_max;
      PrimId id;
      float limit() const { return t_max; }
      void report(const Crossing& crossing) { visit(ShapeHit{crossing, id}); }
    };
    const PreparedRay prepared(ray, bounds_);
    if (!prepared.is_valid()) return;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      Sink sink{visit, prepared.t_max, PrimId(i)};
      intersect_gated(prepared, shapes_[i], sink);
    }
  }

  std::span<const Shape> shapes_;
  Box3 bounds_;
};

template <class Shapes>
BruteForce(const Shapes& shapes) -> BruteForce<std::ranges::range_value_t<Shapes>>;

}  // namespace boxwood::reference
