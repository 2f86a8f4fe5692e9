#include "boxwood/shape/triangle.h"

namespace boxwood {

using detail::narrow;
using detail::Vec3d;
using detail::widen;

Vec3 Triangle::closest_point(Vec3 p) const {
  const Vec3d at = widen(p), va = widen(a), vb = widen(b), vc = widen(c);
  Vec3d best = va;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](Vec3d candidate) {
    const Vec3d to = candidate - at;
    if (const double d2 = dot(to, to); d2 < least) least = d2, best = candidate;
  };
  consider(closest_on_segment(at, va, vb));
  consider(closest_on_segment(at, vb, vc));
  consider(closest_on_segment(at, vc, va));

  // The foot of the perpendicular counts when it lies inside all three edges. For a needle whose normal is
  // mostly rounding it may be anywhere on the triangle; the edges, asked first, are then nearer.
  const Vec3d ab = vb - va, ac = vc - va, ap = at - va;
  const Vec3d n = cross(ab, ac);
  const double n2 = dot(n, n);
  const double v = dot(cross(ab, ap), n), u = dot(cross(ap, ac), n);
  if (n2 > 0 && u > 0 && v > 0 && u + v < n2) consider(va + ab * (u / n2) + ac * (v / n2));
  return narrow(best);
}

Box3 Triangle::clipped_box(const Box3& region) const {
  if (region.is_empty() || !box().overlaps(region)) return {};

  // Everything here is rounded by much less than this; planes are moved outwards by it, and so is the result.
  const Box3 own = box();
  const double slack = 1e-14 * double(std::max(max_component(abs(own.lower)), max_component(abs(own.upper))));
  const auto component = [](const Vec3d& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; };

  // Cut by the six planes in turn; each adds at most one corner.
  Vec3d corners[9] = {widen(a), widen(b), widen(c)}, kept[9];
  int count = 3;
  for (int plane = 0; plane < 6; ++plane) {
    const int axis = plane / 2;
    // Most planes have the whole triangle inside.
    if (plane % 2 == 0 ? own.lower[axis] >= region.lower[axis] : own.upper[axis] <= region.upper[axis])
      continue;
    const double sign = plane % 2 == 0 ? 1 : -1;
    const double place = sign * double(sign > 0 ? region.lower[axis] : region.upper[axis]) - slack;
    const auto height = [&](const Vec3d& p) { return sign * component(p, axis) - place; };
    int kept_count = 0;
    for (int i = 0; i < count; ++i) {
      const Vec3d from = corners[i], to = corners[(i + 1) % count];
      const double h0 = height(from), h1 = height(to);
      if (h0 >= 0) kept[kept_count++] = from;
      if ((h0 >= 0) != (h1 >= 0)) kept[kept_count++] = from + (to - from) * (h0 / (h0 - h1));
    }
    std::copy(kept, kept + kept_count, corners);
    count = kept_count;
  }

  Box3 found;
  const auto down = [&](double x) { return std::nextafter(static_cast<float>(x - slack), -kInfinity); };
  const auto up = [&](double x) { return std::nextafter(static_cast<float>(x + slack), kInfinity); };
  for (int i = 0; i < count; ++i) {
    const Vec3d& p = corners[i];
    found.extend(Box3{{down(p.x), down(p.y), down(p.z)}, {up(p.x), up(p.y), up(p.z)}});
  }
  // The triangle's own box is exact.
  const Box3 inside = boxwood::intersect(found, boxwood::intersect(own, region));
  return inside.is_empty() ? Box3{} : inside;
}

bool Triangle::overlaps(const Box3& box) const {
  if (box.is_empty() || !this->box().overlaps(box)) return false;  // the three axes of the box

  // Move the box to the origin.
  const Vec3d center = (widen(box.lower) + widen(box.upper)) * 0.5;
  const Vec3d half = widen(box.upper) - center;
  const Vec3d v[3] = {widen(a) - center, widen(b) - center, widen(c) - center};

  const auto separated_along = [&](Vec3d axis) {
    const double p0 = dot(axis, v[0]), p1 = dot(axis, v[1]), p2 = dot(axis, v[2]);
    const double reach = half.x * std::fabs(axis.x) + half.y * std::fabs(axis.y) + half.z * std::fabs(axis.z);
    return std::min({p0, p1, p2}) > reach || std::max({p0, p1, p2}) < -reach;
  };

  // The triangle's normal, then the nine cross products of edges and box axes. Degenerate triangles need no
  // case of their own: a zero axis separates nothing, and the others are all that a segment needs.
  const Vec3d edges[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
  if (separated_along(cross(edges[0], edges[1]))) return false;
  for (const Vec3d& e : edges)
    if (separated_along({0, -e.z, e.y}) || separated_along({e.z, 0, -e.x}) || separated_along({-e.y, e.x, 0}))
      return false;
  return true;
}

}  // namespace boxwood
