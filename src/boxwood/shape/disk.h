// disk.h: does a ray cross a flat round disk?
//
// The plane of the disk is met in double, and the distance of that point from the center decides.
#pragma once

#include "boxwood/shape/concept.h"

namespace boxwood {

/// The points of a plane within `radius` of `center`. The facing is a direction of any length. Never hit when
/// the radius is not above 0, when the facing has no direction, or when the ray lies in the plane.
struct Disk {
  Vec3 center;
  Vec3 facing{0, 0, 1};
  float radius = 1;

  Box3 box() const;

  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    double t;
    if (!cross_line(ray.origin, ray.direction, t)) return;
    const auto rounded = static_cast<float>(t);
    if (std::fabs(rounded) < kInfinity) sink.report(Crossing{rounded, 0, 0, 0});
  }

  Vec3 normal(const PreparedRay&, const Crossing&) const;
  Vec3 closest_point(Vec3 p) const;
  bool overlaps(const Box3& box) const;

 private:
  bool cross_line(Vec3 o, Vec3 d, double& t) const {
    if (!(radius > 0)) return false;
    const double fx = double(center.x) - o.x, fy = double(center.y) - o.y, fz = double(center.z) - o.z;
    const double slope = double(facing.x) * d.x + double(facing.y) * d.y + double(facing.z) * d.z;
    if (!(std::fabs(slope) > 0)) return false;
    t = (facing.x * fx + facing.y * fy + facing.z * fz) / slope;
    const double x = t * d.x - fx, y = t * d.y - fy, z = t * d.z - fz;
    return x * x + y * y + z * z <= double(radius) * radius;
  }
};

}  // namespace boxwood
