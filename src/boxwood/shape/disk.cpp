#include "boxwood/shape/disk.h"

#include <array>
#include <vector>

namespace boxwood {
namespace {

struct Vec3d {
  double x, y, z;
};
Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3d operator*(Vec3d a, double s) { return {a.x * s, a.y * s, a.z * s}; }
double dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3d widen(Vec3 a) { return {a.x, a.y, a.z}; }
Vec3 narrow(Vec3d a) { return {float(a.x), float(a.y), float(a.z)}; }

/// The facing at unit length; zero when it has no direction.
Vec3d unit(Vec3 facing) {
  const Vec3d n = widen(facing);
  const double size = std::sqrt(dot(n, n));
  return size > 0 ? n * (1 / size) : Vec3d{0, 0, 0};
}

}  // namespace

Box3 Disk::box() const {
  const Vec3d n = unit(facing);
  if (!(radius > 0) || !(dot(n, n) > 0)) return {};
  // Along axis k the rim reaches radius * sqrt(1 - n_k^2); a little more for rounding.
  const auto reach = [&](double nk, float c) {
    return float(radius * std::sqrt(std::max(0.0, 1 - nk * nk)) * (1 + 0x1p-22)) +
           (std::fabs(c) + radius) * 0x1p-22f;
  };
  const Vec3 r{reach(n.x, center.x), reach(n.y, center.y), reach(n.z, center.z)};
  return {center - r, center + r};
}

Vec3 Disk::normal(const PreparedRay&, const Crossing&) const { return narrow(unit(facing)); }

Vec3 Disk::closest_point(Vec3 p) const {
  const Vec3d n = unit(facing), c = widen(center), to_p = widen(p) - c;
  Vec3d flat = to_p - n * dot(n, to_p);  // the projection on the plane, from the center
  const double size = std::sqrt(dot(flat, flat));
  if (size > radius) flat = flat * (radius / size);
  return narrow(c + flat);
}

bool Disk::overlaps(const Box3& box) const {
  const Vec3d n = unit(facing), c = widen(center);
  if (box.is_empty() || !(radius > 0) || !(dot(n, n) > 0) || !this->box().overlaps(box)) return false;

  // Cut the box with the disk's plane: where each of the twelve edges crosses it.
  std::array<Vec3d, 8> corner;
  std::array<double, 8> side;
  for (int i = 0; i < 8; ++i) {
    corner[i] = widen(box.corner(i)) - c;
    side[i] = dot(n, corner[i]);
  }
  std::vector<Vec3d> points;
  for (int i = 0; i < 8; ++i) {
    if (side[i] == 0) points.push_back(corner[i]);
    for (int bit : {1, 2, 4})
      if (const int j = i | bit; j != i && side[i] * side[j] < 0)
        points.push_back(corner[i] + (corner[j] - corner[i]) * (side[i] / (side[i] - side[j])));
  }
  if (points.empty()) return false;

  // The cut is a convex polygon. It overlaps when the center is in the box, or when one of its edges (a segment between two
  // of its points; those that are diagonals lie inside, so testing all pairs is right too) comes within the radius.
  if (box.contains(center)) return true;
  const double r2 = double(radius) * radius;
  for (const Vec3d& a : points)
    for (const Vec3d& b : points) {
      const Vec3d along = b - a;
      const double size2 = dot(along, along);
      const double s = size2 > 0 ? std::clamp(-dot(a, along) / size2, 0.0, 1.0) : 0.0;
      const Vec3d nearest = a + along * s;
      if (dot(nearest, nearest) <= r2) return true;
    }
  return false;
}

}  // namespace boxwood
