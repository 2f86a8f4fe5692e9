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

#include <bit>
#include <cstdint>

#include "boxwood/core/lanes.h"
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
  RayShear(Vec3 origin, Vec3 direction) : origin(origin) {
    const int longest = longest_axis(abs(direction));
    set_shear(direction, longest, 1.0f / direction[longest]);
  }

 protected:
  /// `inverse` is that of the direction's component along `longest`, its longest.
  void set_shear(Vec3 direction, int longest, float inverse) {
    axis_z = longest;
    axis_x = longest == 2 ? 0 : longest + 1;
    axis_y = longest == 0 ? 2 : longest - 1;
    shear_z = inverse;
    shear_x = direction[axis_x] * inverse;
    shear_y = direction[axis_y] * inverse;
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
    const float near_plane = is_backward(axis) ? upper : lower;
    const float far_plane = is_backward(axis) ? lower : upper;
    return {near_plane * rows_.inverse[axis] + rows_.near_shift[axis],
            far_plane * rows_.inverse[axis] + rows_.far_shift[axis]};
  }
  /// The same ray for boxes that need `factor` times the slack; at least 1.
  PreparedRay widened(float factor) const {
    PreparedRay ray = *this;
    for (int k = 0; k < 3; ++k) {
      const float more = (rows_.far_shift[k] - rows_.near_shift[k]) * ((factor - 1) * 0.5f);
      ray.rows_.near_shift[k] = rows_.near_shift[k] - more;
      ray.rows_.far_shift[k] = rows_.far_shift[k] + more;
    }
    return ray;
  }
  /// The constants of the slabs, as in the file's head; 0 and -+inf on an axis that culls nothing.
  Vec3 inverse() const { return {rows_.inverse[0], rows_.inverse[1], rows_.inverse[2]}; }
  Vec3 near_shift() const { return {rows_.near_shift[0], rows_.near_shift[1], rows_.near_shift[2]}; }
  Vec3 far_shift() const { return {rows_.far_shift[0], rows_.far_shift[1], rows_.far_shift[2]}; }
  /// Whether the ray meets the planes across `axis` from the upper to the lower.
  bool is_backward(int axis) const { return std::bit_cast<std::uint32_t>(rows_.backward[axis]) != 0; }

  /// The interval of the whole line (t from -inf to +inf) inside `box`: what its three slabs share.
  Interval interval(const Box3& box) const { return part(box, -kInfinity, kInfinity); }

  /// Nothing inside `box` is hit at a smaller t than this; +inf when nothing inside it is hit at all.
  /// Law: at most the bound of any box inside it.
  float bound(const Box3& box) const {
    const Interval in = part(box, t_min, kInfinity);
    return in.is_empty() ? kInfinity : in.entry;
  }

  /// The bounds of two boxes at little more than the price of one: entries and exits, in the first two lanes.
  /// Nothing inside a box is hit at a t of at most `limit` where the entry is behind the exit; elsewhere
  /// the entry is its bound.
  struct TwoIntervals {
    Lanes entry, exit;
  };
  BOXWOOD_ALWAYS_INLINE TwoIntervals parts(const Box3& first, const Box3& second, float limit) const {
    const Planes a = planes(first), b = planes(second);
    const Lanes entry = max(zip_low(a.near, b.near), Lanes::all(t_min));
    const Lanes exit = min(zip_low(a.far, b.far), Lanes::all(limit));
    return {max(max(zip_high(a.near, b.near), entry), entry.high()),
            min(min(zip_high(a.far, b.far), exit), exit.high())};
  }

 private:
  /// Constants of the slabs, a lane for each axis; the fourth is 0.
  struct alignas(16) Rows {
    float backward[4] = {};  ///< All bits set where the ray goes backward.
    float inverse[4] = {}, near_shift[4] = {}, far_shift[4] = {};
  };
  Rows rows_;

  /// Where the line meets the near and the far planes of a box, in the first three lanes.
  struct Planes {
    Lanes near, far;
  };
  BOXWOOD_ALWAYS_INLINE Planes planes(const Box3& box) const {
    static_assert(sizeof(Box3) == 24);
    // Both corners by four floats each, which begin with the lower and end with the upper.
    const char* const bytes = reinterpret_cast<const char*>(&box);
    Lanes near = Lanes::load(bytes), far = Lanes::load(bytes + 8).from_second();
    swap_where(Lanes::load(rows_.backward), near, far);
    const Lanes inverse = Lanes::load(rows_.inverse);
    return {near * inverse + Lanes::load(rows_.near_shift), far * inverse + Lanes::load(rows_.far_shift)};
  }
  /// The interval inside `box` between two bounds. A NaN, from an infinite plane times 0, stands first in
  /// each max and min, and never replaces a number.
  Interval part(const Box3& box, float begin, float end) const {
    const Planes at = planes(box);
    const Lanes entry = max(at.near, Lanes::all(begin)), exit = min(at.far, Lanes::all(end));
    return {max(entry.v[0], max(entry.v[1], entry.v[2])), min(exit.v[0], min(exit.v[1], exit.v[2]))};
  }

  void prepare(const Box3& bounds) {
    const Vec3 size = abs(direction);
    const float d_max = max_component(size);
    const bool usable = is_finite(origin) && is_finite(direction) && d_max >= 0x1p-96f && d_max <= 0x1p96f;
    if (!usable || !(t_max >= t_min)) {
      t_max = -kInfinity;
      return;
    }

    constexpr float u = 0x1p-24f;
    const auto lanes = [](Vec3 v) { return Lanes{Lanes::Register{v.x, v.y, v.z, 0}}; };
    const auto size_of = [](Lanes a) { return max(a, Lanes::all(0) - a); };
    const Lanes o = lanes(origin), size_of_o = size_of(o);
    float reach = 0;
    if (!bounds.is_empty()) {
      const Lanes farthest = max(size_of(lanes(bounds.lower) - o), size_of(lanes(bounds.upper) - o));
      reach = max(farthest.v[0], max(farthest.v[1], farthest.v[2]));
    }
    const Lanes d = max(lanes(size), Lanes::all(d_max * 0x1p-30f)).with_signs_of(lanes(direction));
    const Lanes r = Lanes::all(1) / d, size_of_r = size_of(r);

    // The two tiny terms cover what underflows: positions before, and t after the multiplication.
    const Lanes tiny = Lanes::all(0x1p-140f);
    const Lanes slack =
        size_of_r * (Lanes::all(12 * u * reach) + Lanes::all(8 * u) * size_of_o + tiny) + tiny;
    const Lanes middle = Lanes::all(0) - o * r;

    // Where products could overflow, an axis culls nothing.
    const Lanes largest = (Lanes::all(reach) + size_of_o) * size_of_r, limit = Lanes::all(0x1p120f);
    const Lanes zero = Lanes::all(0), infinity = Lanes::all(kInfinity);
    select_less(d, zero, Lanes::all(std::bit_cast<float>(~0u)), zero).store(rows_.backward);
    select_less(largest, limit, r, zero).store(rows_.inverse);
    select_less(largest, limit, middle - slack, zero - infinity).store(rows_.near_shift);
    select_less(largest, limit, middle + slack, infinity).store(rows_.far_shift);

    // The longest component is as it was, so its inverse is known.
    const int longest = longest_axis(size);
    set_shear(direction, longest, longest == 0 ? r.v[0] : longest == 1 ? r.v[1] : r.v[2]);
  }
};

}  // namespace boxwood
