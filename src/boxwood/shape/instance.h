// instance.h: how does one thing stand in many places?
//
// The ray is taken into the object's space, not the object into the world; t is the same in both, because the
// direction is not normalized. The transform rounds, so a crossing counts only inside the instance's world
// box (gate.h).
#pragma once

#include <stdexcept>

#include "boxwood/core/affine.h"
#include "boxwood/shape/gate.h"
#include "boxwood/shape/vec3d.h"

namespace boxwood {

/// Whether the map keeps the shape of things: moves, turns, mirrors and scales by one factor, up to the
/// rounding of its entries.
bool is_similarity(const Affine3& map);

/// An object of any kind under a transform. `part` of a crossing: the object's own. Keeps a pointer: the
/// object must outlive it. A scale so strong that a ray's direction leaves the range that Ray allows makes
/// that ray miss.
template <ShapeType Object>
class InstanceOf {
 public:
  /// Throws std::invalid_argument when the transform has no inverse.
  InstanceOf(const Object& object, const Affine3& world_from_object)
      : object_(&object),
        world_from_object_(world_from_object),
        object_from_world_(inverse(world_from_object)),
        object_box_(object.box()),
        world_box_(transform_box(world_from_object, object_box_)),
        keeps_shape_(is_similarity(world_from_object)) {}

  Box3 box() const { return world_box_; }

  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    const Interval inside = ray.interval(world_box_);
    if (inside.is_empty()) return;
    const PreparedRay local = in_object_space(ray, inner_t_min(ray, inside), sink.limit());
    if (local.is_valid()) intersect_gated(local, *object_, sink);
  }

  Vec3 normal(const PreparedRay& ray, const Crossing& crossing) const {
    using namespace detail;
    const PreparedRay local = in_object_space(ray, -kInfinity, kInfinity);
    const Vec3d n = widen(object_->normal(local, crossing));
    const Affine3& m = object_from_world_;  // a normal is a covector: it goes by the inverse's transpose
    return narrow(unit({dot(widen(m.x), n), dot(widen(m.y), n), dot(widen(m.z), n)}));
  }

  /// Throws std::logic_error unless the transform is a similarity:
  /// only then is the nearest point the same in both spaces.
  Vec3 closest_point(Vec3 p) const requires HasClosestPoint<Object> {
    if (!keeps_shape_)
      throw std::logic_error(
          "InstanceOf: closest_point needs a transform that moves, turns, mirrors or scales evenly");
    return world_from_object_.point(object_->closest_point(object_from_world_.point(p)));
  }

  const Object& object() const { return *object_; }
  const Affine3& world_from_object() const { return world_from_object_; }

 private:
  PreparedRay in_object_space(const PreparedRay& ray, float t_min, float t_max) const {
    return {object_from_world_.point(ray.origin), object_from_world_.vector(ray.direction), t_min, t_max,
            object_box_};
  }

  const Object* object_;
  Affine3 world_from_object_, object_from_world_;
  Box3 object_box_, world_box_;
  bool keeps_shape_;
};

}  // namespace boxwood
