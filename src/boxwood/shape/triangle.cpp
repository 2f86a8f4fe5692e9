#include "boxwood/shape/triangle.h"

namespace boxwood {
namespace {

struct Vec3d {
  double x, y, z;
};
Vec3d widen(Vec3 a) { return {a.x, a.y, a.z}; }
Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3d cross(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace

Vec3 Triangle::normal() const {
  const Vec3d n = cross(widen(b) - widen(a), widen(c) - widen(a));
  const double size = std::sqrt(dot(n, n));
  if (!(size > 0)) return {0, 0, 0};
  return {float(n.x / size), float(n.y / size), float(n.z / size)};
}

Vec3 Triangle::closest_point(Vec3 p) const {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;  // the region in front of vertex a

  const Vec3 bp = p - b;
  const float d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;

  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return d1 - d3 > 0 ? a + ab * (d1 / (d1 - d3)) : a;  // edge ab

  const Vec3 cp = p - c;
  const float d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;

  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return d2 - d6 > 0 ? a + ac * (d2 / (d2 - d6)) : a;  // edge ac

  const float va = d3 * d6 - d5 * d4;
  const float along = d4 - d3, back = d5 - d6;
  if (va <= 0 && along >= 0 && back >= 0) return along + back > 0 ? b + (c - b) * (along / (along + back)) : b;

  const float sum = va + vb + vc;  // inside the face
  if (!(sum > 0)) return a;
  return a + ab * (vb / sum) + ac * (vc / sum);
}

bool Triangle::overlaps(const Box3& box) const {
  if (box.is_empty() || !this->box().overlaps(box)) return false;  // the three axes of the box

  // Move the box to the origin.
  const Vec3d center{0.5 * box.lower.x + 0.5 * box.upper.x, 0.5 * box.lower.y + 0.5 * box.upper.y,
                     0.5 * box.lower.z + 0.5 * box.upper.z};
  const Vec3d half = widen(box.upper) - center;
  const Vec3d v[3] = {widen(a) - center, widen(b) - center, widen(c) - center};

  const auto separated_along = [&](Vec3d axis) {
    const double p0 = dot(axis, v[0]), p1 = dot(axis, v[1]), p2 = dot(axis, v[2]);
    const double reach = half.x * std::fabs(axis.x) + half.y * std::fabs(axis.y) + half.z * std::fabs(axis.z);
    return std::min({p0, p1, p2}) > reach || std::max({p0, p1, p2}) < -reach;
  };

  // The triangle's normal, then the nine cross products of edges and box axes.
  const Vec3d edges[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
  if (separated_along(cross(edges[0], edges[1]))) return false;
  for (const Vec3d& e : edges)
    if (separated_along({0, -e.z, e.y}) || separated_along({e.z, 0, -e.x}) || separated_along({-e.y, e.x, 0}))
      return false;
  return true;
}

}  // namespace boxwood
