// ball.h: does a ray come near a few shapes at all?
//
// Scenes of triangles often have some other shapes, such as lamps that are spheres. A walk to them takes as
// long as half of a ray among a million triangles; most rays keep clear of all of them, and a ball around
// them says so at once, without a division. It may err on one side only: a walk reports a crossing at most
// 20 u (R + |o|) away from the shape's box on each axis, 35 u (R + |o|) in all (u = 2^-24; see
// core/prepared_ray.h). The ball is wider by 128 u (|o| + the largest coordinate of the scene), |o| in the
// sum norm, which is more than three times as much and covers the rounding of the test itself.
#pragma once

#include <cmath>

#include "boxwood/core/box.h"
#include "boxwood/core/ray.h"

namespace boxwood {

class Ball {
 public:
  Ball() = default;
  /// Around `box`, in a scene of these bounds.
  Ball(const Box3& box, const Box3& bounds)
      : center_(box.center()),
        radius_(length(box.upper * 0.5f - box.lower * 0.5f)),
        reach_(max_component(max(abs(bounds.lower), abs(bounds.upper)))) {}

  /// False when nothing inside can be hit at a t from 0 to `t_max`. What is not a number, or beyond them,
  /// compares as "perhaps".
  bool may_meet(const Ray& ray, float t_max) const {
    const Vec3 way = center_ - ray.origin, size = abs(ray.origin);
    const float wide = radius_ + 0x1p-17f * (size.x + size.y + size.z + reach_);
    const float wide_squared = wide * wide;
    const Vec3 across = cross(way, ray.direction);
    if (dot(across, across) > wide_squared * dot(ray.direction, ray.direction)) return false;
    // The line passes it; behind the origin, or beyond the end?
    if (dot(way, ray.direction) < 0 && dot(way, way) > wide_squared) return false;
    const Vec3 left = way - ray.direction * t_max;
    return !(dot(left, ray.direction) > 0 && dot(left, left) > wide_squared);
  }

 private:
  Vec3 center_{0, 0, 0};
  float radius_ = 0, reach_ = 0;
};

}  // namespace boxwood
