// instance.h: how does one thing stand in many places?
//
// The ray is taken into the object's space, not the object into the world; t is the same in both, because the direction is
// not normalized. The transform rounds, so a crossing counts only inside the instance's world box (gate.h).
#pragma once

#include "boxwood/core/affine.h"
#include "boxwood/shape/gate.h"

namespace boxwood {

/// An object of any kind under a transform. Keeps a pointer: the object must outlive it.
template <ShapeType Object>
class InstanceOf {
 public:
  /// Throws std::invalid_argument when the transform has no inverse.
  InstanceOf(const Object& object, const Affine3& world_from_object)
      : object_(&object),
        world_from_object_(world_from_object),
        object_from_world_(inverse(world_from_object)),
        object_box_(object.box()),
        world_box_(transform_box(world_from_object, object_box_)) {}

  Box3 box() const { return world_box_; }

  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    const Interval inside = ray.interval(world_box_);
    if (inside.is_empty()) return;
    const PreparedRay local = in_object_space(ray, inner_t_min(ray, inside), sink.limit());
    if (local.is_valid()) intersect_gated(local, *object_, sink);
  }

  Vec3 normal(const PreparedRay& ray, const Crossing& crossing) const {
    const PreparedRay local = in_object_space(ray, -kInfinity, kInfinity);
    return normalize(transform_normal(object_from_world_, object_->normal(local, crossing)));
  }

  const Object& object() const { return *object_; }
  const Affine3& world_from_object() const { return world_from_object_; }

 private:
  PreparedRay in_object_space(const PreparedRay& ray, float t_min, float t_max) const {
    return {object_from_world_.point(ray.origin), object_from_world_.vector(ray.direction), t_min, t_max, object_box_};
  }

  const Object* object_;
  Affine3 world_from_object_, object_from_world_;
  Box3 object_box_, world_box_;
};

}  // namespace boxwood
