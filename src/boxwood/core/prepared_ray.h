// prepared_ray.h: what does a ray need to know before it meets boxes and triangles?
//
// Everything that depends on the ray alone,
// or on the ray and the bounds of what it will meet, is worked out once.
//
// Boxes. A box test must never lose a hit that a leaf test would report, and a leaf test has rounding errors
// of its own: the watertight triangle test moves a vertex by up to 7uR (u = 2^-24, R = the largest distance,
// in the max norm, from the origin to a corner of the bounds). So the slabs are widened by constants of the
// ray and a box costs one multiply and one add a plane:
//
//     near plane: t = plane * r - (o*r + slack)      r = 1/d       slack = |r| (12 u R + 8 u |o|)
//     far plane:  t = plane * r - (o*r - slack)      |d| is taken as at least 2^-30 of the largest component
//
// Every operation rounds monotonically, so the interval of a box lies inside the interval of any box around
// it. Queries lean on that law: a crossing is reported at a t inside the interval of its own shape's box (see
// shape/gate.h), and therefore no box around it can be culled wrongly. Compare Ize, "Robust BVH Ray
// Traversal", JCGT 2013, which is conservative against exact slabs only and divides by zero components.
//
// Triangles. The shear of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013: the axes
// are permuted so that axis_z is the direction's largest, and a shear makes the ray the z axis.
#pragma once

#include "boxwood/core/ray.h"

namespace boxwood {

/// The part of a ray's line, in t, that a box covers; entry > exit when it covers none.
struct Interval {
  float entry, exit;
  bool is_empty() const { return !(entry <= exit); }
};

/// What the triangle test reads: where the line starts, the axes in the order in which the test takes them,
/// and the constants of the shear.
struct RayShear {
  Vec3 origin;
  int axis_x = 0, axis_y = 1, axis_z = 2;
  float shear_x = 0, shear_y = 0, shear_z = 0;

  RayShear() = default;
  /// The shear alone, for whoever meets one triangle and no box. Precondition: PreparedRay would be valid.
  RayShear(Vec3 origin, Vec3 direction) : origin(origin), axis_z(longest_axis(abs(direction))) {
    axis_x = (axis_z + 1) % 3;
    axis_y = (axis_z + 2) % 3;
    shear_z = 1.0f / direction[axis_z];
    shear_x = direction[axis_x] * shear_z;
    shear_y = direction[axis_y] * shear_z;
  }
};

class PreparedRay : public RayShear {
 public:
  Vec3 direction;
  float t_min, t_max;  ///< t_max = -inf when the ray cannot hit anything (see Ray).

  /// Prepares `ray` to meet things inside `bounds`. Cost: about a hundred instructions.
  PreparedRay(const Ray& ray, const Box3& bounds)
      : PreparedRay(ray.origin, ray.direction, max(ray.t_min, 0.0f), ray.t_max, bounds) {
    if (!(ray.t_min == ray.t_min)) t_max = -kInfinity;
  }

  /// The same for a ray inside an instance, where t_min may be negative or -inf.
  PreparedRay(Vec3 origin, Vec3 direction, float t_min, float t_max, const Box3& bounds)
      : direction(direction), t_min(t_min), t_max(t_max) {
    this->origin = origin;
    prepare(bounds);
  }

  bool is_valid() const { return t_max > -kInfinity && t_max >= t_min; }

  /// The interval between two planes across `axis`, lower <= upper, widened as the file's head says. Both
  /// planes lie within the bounds that the ray was prepared for.
  Interval slab(int axis, float lower, float upper) const {
    const float near_plane = backward_[axis] ? upper : lower;
    const float far_plane = backward_[axis] ? lower : upper;
    return {near_plane * inverse_[axis] + near_shift_[axis], far_plane * inverse_[axis] + far_shift_[axis]};
  }
  /// The same ray for boxes that need `factor` times the slack; at least 1.
  PreparedRay widened(float factor) const {
    PreparedRay ray = *this;
    for (int k = 0; k < 3; ++k) {
      const float more = (far_shift_[k] - near_shift_[k]) * ((factor - 1) * 0.5f);
      ray.near_shift_[k] = near_shift_[k] - more;
      ray.far_shift_[k] = far_shift_[k] + more;
    }
    return ray;
  }
  /// The constants of the slabs, as in the file's head; 0 and -+inf on an axis that culls nothing.
  Vec3 inverse() const { return inverse_; }
  Vec3 near_shift() const { return near_shift_; }
  Vec3 far_shift() const { return far_shift_; }
  /// Whether the ray meets the planes across `axis` from the upper to the lower.
  bool is_backward(int axis) const { return backward_[axis]; }

  /// The interval of the whole line (t from -inf to +inf) inside `box`: what its three slabs share.
  Interval interval(const Box3& box) const {
    // A select, not std::max: a NaN, from an infinite plane times 0, never replaces a number.
    float entry = -kInfinity, exit = kInfinity;
    for (int k = 0; k < 3; ++k) {
      const Interval across = slab(k, box.lower[k], box.upper[k]);
      entry = max(across.entry, entry);
      exit = min(across.exit, exit);
    }
    return {entry, exit};
  }

  /// Nothing inside `box` is hit at a smaller t than this; +inf when nothing inside it is hit at all.
  /// Law: at most the bound of any box inside it.
  float bound(const Box3& box) const {
    const Interval in = interval(box);
    const float entry = max(in.entry, t_min);
    return entry <= in.exit ? entry : kInfinity;
  }

 private:
  Vec3 inverse_, near_shift_, far_shift_;
  bool backward_[3] = {false, false, false};

  void prepare(const Box3& bounds) {
    const float d_max = max_component(abs(direction));
    const bool usable = is_finite(origin) && is_finite(direction) && d_max >= 0x1p-96f && d_max <= 0x1p96f;
    if (!usable || !(t_max >= t_min)) {
      t_max = -kInfinity;
      return;
    }
    static_cast<RayShear&>(*this) = RayShear(origin, direction);

    constexpr float u = 0x1p-24f;
    const float reach = bounds.is_empty() ? 0.0f
                                          : max(max_component(abs(bounds.lower - origin)),
                                                max_component(abs(bounds.upper - origin)));
    for (int k = 0; k < 3; ++k) {
      const float d = std::copysign(max(std::fabs(direction[k]), d_max * 0x1p-30f), direction[k]);
      const float r = 1.0f / d;
      backward_[k] = d < 0;
      // The two tiny terms cover what underflows: positions before, and t after the multiplication.
      const float slack =
          std::fabs(r) * (12 * u * reach + 8 * u * std::fabs(origin[k]) + 0x1p-140f) + 0x1p-140f;
      inverse_[k] = r;
      near_shift_[k] = -(origin[k] * r) - slack;
      far_shift_[k] = -(origin[k] * r) + slack;

      // Where products could overflow, this axis culls nothing.
      if (!((reach + std::fabs(origin[k])) * std::fabs(r) < 0x1p120f)) {
        inverse_[k] = 0;
        near_shift_[k] = -kInfinity;
        far_shift_[k] = kInfinity;
      }
    }
  }
};

}  // namespace boxwood
