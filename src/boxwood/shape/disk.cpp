#include "boxwood/shape/disk.h"

#include <array>

#include "boxwood/shape/vec3d.h"

namespace boxwood {

using detail::narrow;
using detail::Vec3d;
using detail::widen;

Box3 Disk::box() const {
  const Vec3d n = unit(widen(facing));
  if (!(radius > 0) || !(dot(n, n) > 0)) return {};
  // Along axis k the rim reaches radius * sqrt(1 - n_k^2); a little more for rounding.
  const auto reach = [&](double nk, float c) {
    return float(radius * std::sqrt(std::max(0.0, 1 - nk * nk)) * (1 + 0x1p-22)) +
           (std::fabs(c) + radius) * 0x1p-22f;
  };
  const Vec3 r{reach(n.x, center.x), reach(n.y, center.y), reach(n.z, center.z)};
  return {center - r, center + r};
}

Vec3 Disk::normal(const PreparedRay&, const Crossing&) const {
  return narrow(unit(widen(facing)));
}

Vec3 Disk::closest_point(Vec3 p) const {
  const Vec3d n = unit(widen(facing)), c = widen(center), to_p = widen(p) - c;
  Vec3d flat = to_p - n * dot(n, to_p);  // the projection on the plane, from the center
  const double size = std::sqrt(dot(flat, flat));
  if (size > radius) flat = flat * (radius / size);
  return narrow(c + flat);
}

bool Disk::overlaps(const Box3& box) const {
  if (box.is_empty() || !this->box().overlaps(box)) return false;
  if (box.contains(center)) return true;

  // Cut the box with the disk's plane: at most eight corners lie in it, and it crosses at most twelve edges.
  const Vec3d n = widen(facing), c = widen(center);
  std::array<Vec3d, 8> corner;
  std::array<double, 8> side;
  for (int i = 0; i < 8; ++i) {
    corner[i] = widen(box.corner(i)) - c;
    side[i] = dot(n, corner[i]);
  }
  std::array<Vec3d, 20> cut;
  int count = 0;
  for (int i = 0; i < 8; ++i) {
    if (side[i] == 0) cut[count++] = corner[i];
    for (int bit : {1, 2, 4})
      if (const int j = i | bit; j != i && (side[i] < 0) != (side[j] < 0) && side[i] != 0 && side[j] != 0)
        cut[count++] = corner[i] + (corner[j] - corner[i]) * (side[i] / (side[i] - side[j]));
  }

  // The cut is a convex polygon without the center inside, so its nearest point is on an edge. The segments
  // between all pairs of its points are its edges and diagonals, and a diagonal is in the box as well.
  const double r2 = double(radius) * radius;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j <= i; ++j) {
      const Vec3d nearest = closest_on_segment(Vec3d{}, cut[i], cut[j]);
      if (dot(nearest, nearest) <= r2) return true;
    }
  return false;
}

}  // namespace boxwood
