// structure.h: what does every rival answer, and how is its work counted?
//
// Each structure of this room offers one thing, a walk: it shows a query every primitive that may matter to a
// ray. The questions on top are the library's own queries, so a rival can differ from brute force in one way
// only: by losing a primitive. None does. A crossing counts only at a t inside the interval of its shape's
// box (shape/gate.h), and intervals are monotonic (core/prepared_ray.h); hence each space-splitting rival
// keeps this law:
//
//   When a shape's box has t in its interval, so has a cell that lists the shape, and the walk reaches that
//   cell.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

#include "boxwood/query/any_hit.h"
#include "boxwood/query/closest_hit.h"

namespace boxwood::reference {

/// Adds up the work of many rays, and how often one ray tests a shape again that it has tested before.
class RivalStatistics {
 public:
  std::uint64_t box_tests = 0;       ///< Boxes; for a kd-tree planes met, for a grid cells entered.
  std::uint64_t shape_tests = 0;     ///< Repeated ones too.
  std::uint64_t repeated_tests = 0;  ///< Of shape_tests: the same ray had tested the same shape.

  void begin_ray() { ++ray_; }
  void count_boxes(int n) { box_tests += static_cast<std::uint64_t>(n); }
  void count_shape(PrimId id) {
    if (id.value >= last_ray_.size()) last_ray_.resize(std::size_t(id.value) + 1, 0);
    ++shape_tests;
    if (last_ray_[id.value] == ray_) ++repeated_tests;
    last_ray_[id.value] = ray_;
  }

 private:
  std::uint64_t ray_ = 0;
  std::vector<std::uint64_t> last_ray_;  // for each shape the last ray that tested it; rays count from 1
};

/// Counts nothing, and costs nothing.
struct NoRivalStatistics {
  void begin_ray() {}
  void count_boxes(int) {}
  void count_shape(PrimId) {}
};

/// Shows one primitive to `query` and counts it.
template <Query Q, class Statistics>
void visit(Q& query, PrimId id, Statistics& statistics) {
  statistics.count_shape(id);
  query.visit(id);
}

/// A query that wants nothing; stands in where a concept needs some query.
struct NullQuery {
  float bound(const Box3&) const { return kInfinity; }
  float limit() const { return -kInfinity; }
  void visit(PrimId) const {}
};

/// Law: bounds() is the union of the boxes of all shapes; walk() visits every primitive whose crossing the
/// query would take, in any order, perhaps more than once.
template <class S>
concept Structure = requires(const S& structure, const PreparedRay& ray, NullQuery& query,
                             NoRivalStatistics& statistics) {
  { structure.bounds() } -> std::same_as<Box3>;
  { structure.size_bytes() } -> std::same_as<std::size_t>;  // what the structure adds to the shapes
  {structure.walk(ray, query, statistics)};
};

/// The crossing with the smallest t in [ray.t_min, ray.t_max], equal t by the smallest id; a miss has t =
/// +inf. `structure` was built over boxes(shapes), in the same order.
template <Structure S, ShapeType Shape, class Statistics>
ShapeHit closest_hit(const S& structure, std::span<const Shape> shapes, const Ray& ray,
                     Statistics& statistics) {
  statistics.begin_ray();
  const PreparedRay prepared(ray, structure.bounds());
  if (!prepared.is_valid()) return {};
  ClosestHitQuery<Shape> query(prepared, shapes);
  structure.walk(prepared, query, statistics);
  return query.result();
}

/// Whether anything is hit in [ray.t_min, ray.t_max].
template <Structure S, ShapeType Shape, class Statistics>
bool any_hit(const S& structure, std::span<const Shape> shapes, const Ray& ray, Statistics& statistics) {
  statistics.begin_ray();
  const PreparedRay prepared(ray, structure.bounds());
  if (!prepared.is_valid()) return false;
  AnyHitQuery<Shape> query(prepared, shapes);
  structure.walk(prepared, query, statistics);
  return query.found();
}

template <Structure S, class Shapes>
ShapeHit closest_hit(const S& structure, const Shapes& shapes, const Ray& ray) {
  NoRivalStatistics none;
  return closest_hit(structure, std::span(std::as_const(shapes)), ray, none);
}

template <Structure S, class Shapes>
bool any_hit(const S& structure, const Shapes& shapes, const Ray& ray) {
  NoRivalStatistics none;
  return any_hit(structure, std::span(std::as_const(shapes)), ray, none);
}

/// The union of `boxes`. Throws std::invalid_argument that names the first box that is neither finite nor
/// empty, or when there are 2^32 - 1 of them or more.
Box3 checked_bounds(std::span<const Box3> boxes);

}  // namespace boxwood::reference
