#include "boxwood/shape/sphere.h"

namespace boxwood {

Vec3 Sphere::normal(const PreparedRay& ray, const Crossing& crossing) const {
  const double t = crossing.t;
  const double x = ray.origin.x + t * ray.direction.x - center.x;
  const double y = ray.origin.y + t * ray.direction.y - center.y;
  const double z = ray.origin.z + t * ray.direction.z - center.z;
  const double size = std::sqrt(x * x + y * y + z * z);
  if (!(size > 0)) return {0, 0, 1};
  return {float(x / size), float(y / size), float(z / size)};
}

Vec3 Sphere::closest_point(Vec3 p) const {
  const double x = double(p.x) - center.x, y = double(p.y) - center.y, z = double(p.z) - center.z;
  const double size = std::sqrt(x * x + y * y + z * z);
  if (!(size > 0)) return center + Vec3{radius, 0, 0};  // every point is as near
  const double s = radius / size;
  return {float(center.x + s * x), float(center.y + s * y), float(center.z + s * z)};
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
