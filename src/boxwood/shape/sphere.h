// sphere.h: does a ray cross a sphere?
//
// Solved in double, where the squares of any float are exact enough and cannot overflow, with the
// discriminant taken from the distance between the center and the line (Haines et al., "Precision
// Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019). A line that only touches does not
// cross.
#pragma once

#include "boxwood/shape/concept.h"

namespace boxwood {

/// The surface of a ball. `part` of a crossing: 0 where the line enters, 1 where it leaves. Never hit when
/// the radius is not above 0.
struct Sphere {
  Vec3 center;
  float radius = 1;

  Box3 box() const {
    if (!(radius > 0)) return {};
    const Vec3 reach = splat(radius + radius * 0x1p-22f) + abs(center) * 0x1p-22f;
    return {center - reach, center + reach};
  }

  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    double t[2];
    if (!cross_line(ray.origin, ray.direction, t)) return;
    for (std::uint32_t part = 0; part < 2; ++part) {
      const auto rounded = static_cast<float>(t[part]);
      if (std::fabs(rounded) < kInfinity) sink.report(Crossing{rounded, 0, 0, part});
    }
  }

  Vec3 normal(const PreparedRay& ray, const Crossing& crossing) const;
  Vec3 closest_point(Vec3 p) const;
  bool overlaps(const Box3& box) const;

 private:
  bool cross_line(Vec3 o, Vec3 d, double t[2]) const {
    if (!(radius > 0)) return false;
    const double fx = double(center.x) - o.x, fy = double(center.y) - o.y, fz = double(center.z) - o.z;
    const double a = double(d.x) * d.x + double(d.y) * d.y + double(d.z) * d.z;
    const double b = fx * d.x + fy * d.y + fz * d.z;

    // The foot of the perpendicular from the center to the line.
    const double s = b / a;
    const double lx = fx - s * d.x, ly = fy - s * d.y, lz = fz - s * d.z;
    const double inside = double(radius) * radius - (lx * lx + ly * ly + lz * lz);
    if (!(inside > 0)) return false;  // most lines end here, without another division
    const double discriminant = inside / a;
    if (!(discriminant > 0)) return false;

    // The root farther from 0 first, the other from their product: no digits are lost.
    const double c = (fx * fx + fy * fy + fz * fz - double(radius) * radius) / a;
    const double root = std::sqrt(discriminant);
    const double far = s >= 0 ? s + root : s - root;
    const double other = far != 0 ? c / far : s - root;
    t[0] = s >= 0 ? other : far;
    t[1] = s >= 0 ? far : other;
    if (!(t[0] <= t[1])) t[0] = t[1] = s;  // rounding met a tangent
    return true;
  }
};

}  // namespace boxwood
