#include "boxwood/shape/sphere.h"

#include "boxwood/shape/vec3d.h"

namespace boxwood {

using detail::narrow;
using detail::Vec3d;
using detail::widen;

Vec3 Sphere::normal(const PreparedRay& ray, const Crossing& crossing) const {
  // Take t as it was before it was rounded to a float,
  // which far from a small sphere would turn the normal about.
  double t[2] = {crossing.t, crossing.t};
  cross_line(ray.origin, ray.direction, t);
  const Vec3d out = widen(ray.origin) - widen(center) + widen(ray.direction) * t[crossing.part & 1];
  const Vec3d n = unit(out);
  return dot(n, n) > 0 ? narrow(n) : Vec3{0, 0, 1};
}

Vec3 Sphere::closest_point(Vec3 p) const {
  const Vec3d out = unit(widen(p) - widen(center));
  if (!(dot(out, out) > 0)) return center + Vec3{radius, 0, 0};  // every point is as near
  return narrow(widen(center) + out * radius);
}

bool Sphere::overlaps(const Box3& box) const {
  if (box.is_empty() || !(radius > 0)) return false;
  // The surface meets the box when the box reaches from inside the ball to outside of it.
  double nearest = 0, farthest = 0;
  for (int k = 0; k < 3; ++k) {
    const double below = double(box.lower[k]) - center[k], above = double(center[k]) - box.upper[k];
    const double outside = std::max({below, above, 0.0}), far = std::max(std::fabs(below), std::fabs(above));
    nearest += outside * outside;
    farthest += far * far;
  }
  const double r2 = double(radius) * radius;
  return nearest <= r2 && r2 <= farthest;
}

}  // namespace boxwood
