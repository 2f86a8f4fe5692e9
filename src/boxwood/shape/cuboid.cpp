#include "boxwood/shape/cuboid.h"

namespace boxwood {

Vec3 Cuboid::closest_point(Vec3 p) const {
  const Vec3 inside = min(max(p, lower), upper);
  if (inside != p) return inside;

  // Within the block: go to the nearest face.
  Vec3 best = p;
  float nearest = kInfinity;
  for (int k = 0; k < 3; ++k)
    for (const float plane : {lower[k], upper[k]})
      if (const float distance = std::fabs(p[k] - plane); distance < nearest) {
        nearest = distance;
        best = p;
        best[k] = plane;
      }
  return best;
}

bool Cuboid::overlaps(const Box3& other) const {
  // Touches, and is not swallowed by the block's inside.
  if (other.is_empty() || !box().overlaps(other)) return false;
  for (int k = 0; k < 3; ++k)
    if (other.lower[k] <= lower[k] || other.upper[k] >= upper[k]) return true;
  return false;
}

}  // namespace boxwood
