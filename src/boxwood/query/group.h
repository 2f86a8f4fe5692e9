// group.h: how does a tree of shapes become a shape itself?
//
// A Group owns shapes and a tree over them and meets the concept, so that InstanceOf<Group<Triangle>> places
// a whole mesh, and groups of instances of groups nest to any depth. Its box holds the boxes of its shapes,
// so the gate around the group (shape/gate.h) moves nothing that the gates of the shapes have let through.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "boxwood/query/closest_point.h"
#include "boxwood/query/traverse.h"
#include "boxwood/shape/gate.h"

namespace boxwood {

/// Shapes under one tree. `part` of a crossing: the id of the shape in the group.
template <ShapeType Inner>
class Group {
 public:
  /// `bvh` was built over boxes(shapes). Throws std::invalid_argument when it is a tree of another number of
  /// shapes.
  Group(Bvh bvh, std::vector<Inner> shapes) : bvh_(std::move(bvh)), shapes_(std::move(shapes)) {
    if (bvh_.prim_ids.size() != shapes_.size())
      throw std::invalid_argument("Group: the tree has " + std::to_string(bvh_.prim_ids.size()) +
                                  " primitives, expected one for each of the " +
                                  std::to_string(shapes_.size()) + " shapes");
  }

  Box3 box() const { return bvh_.bounds(); }

  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    struct Walk {
      const PreparedRay& ray;
      std::span<const Inner> shapes;
      std::remove_reference_t<Sink>& sink;
      float bound(const Box3& box) const { return ray.bound(box); }
      float limit() const { return sink.limit(); }
      void visit(PrimId id) {
        PartSink<std::remove_reference_t<Sink>> part{sink, id};
        intersect_gated(ray, shapes[id.value], part);
      }
    } walk{ray, shapes_, sink};
    traverse(bvh_, walk);
  }

  /// Asks the shape that was hit for its crossings again, because `part` no longer holds the shape's own, and
  /// takes the normal at the one that is meant.
  Vec3 normal(const PreparedRay& ray, const Crossing& crossing) const {
    struct Matcher {
      Crossing wanted, best;
      float best_miss = kInfinity;
      float limit() const { return kInfinity; }
      void report(const Crossing& candidate) {
        // The surface parameters are passed on untouched;
        // t may have been moved a little by the gates in between.
        const float miss = std::fabs(candidate.t - wanted.t);
        if (candidate.u == wanted.u && candidate.v == wanted.v && miss < best_miss)
          best = candidate, best_miss = miss;
      }
    } matcher{crossing, crossing};
    const Inner& shape = shapes_[crossing.part];
    shape.intersect(ray, matcher);
    return shape.normal(ray, matcher.best);
  }

  /// Of an empty group: infinitely far.
  Vec3 closest_point(Vec3 p) const requires HasClosestPoint<Inner> {
    const ShapePoint nearest = boxwood::closest_point(bvh_, shapes_, p);
    return nearest.is_found() ? nearest.position : splat(kInfinity);
  }

  bool overlaps(const Box3& region) const requires HasOverlap<Inner> {
    struct Walk {
      const Box3& region;
      std::span<const Inner> shapes;
      bool found = false;
      float bound(const Box3& box) const { return box.overlaps(region) ? 0.0f : kInfinity; }
      float limit() const { return found ? -kInfinity : 0.0f; }
      void visit(PrimId id) {
        const Inner& shape = shapes[id.value];
        found = found || (shape.box().overlaps(region) && shape.overlaps(region));
      }
    } walk{region, shapes_};
    traverse(bvh_, walk);
    return walk.found;
  }

  const Bvh& bvh() const { return bvh_; }
  const std::vector<Inner>& shapes() const { return shapes_; }

 private:
  template <class Sink>
  struct PartSink {
    Sink& sink;
    PrimId id;
    float limit() { return sink.limit(); }
    void report(Crossing crossing) {
      crossing.part = id.value;
      sink.report(crossing);
    }
  };

  Bvh bvh_;
  std::vector<Inner> shapes_;
};

}  // namespace boxwood
