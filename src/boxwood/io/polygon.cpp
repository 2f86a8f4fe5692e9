#include "boxwood/io/polygon.h"

#include <numeric>

namespace boxwood::io {
namespace {

// Above this a concave polygon is filled by a fan, so that a hostile file cannot ask for quadratic work.
constexpr std::size_t kMostCornersToClip = 1024;

struct Point {
  double x, y;
  friend bool operator==(const Point&, const Point&) = default;
};

// Twice the signed area of the triangle a b c; positive when it turns left.
double turn(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_inside(Point p, Point a, Point b, Point c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

// The outline as seen against its Newell normal, that is, counterclockwise;
// by dropping the normal's largest axis.
std::vector<Point> flatten(std::span<const Vec3> outline) {
  double normal[3] = {0, 0, 0};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec3 a = outline[i], b = outline[(i + 1) % outline.size()];
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      normal[axis] += (double(a[u]) - b[u]) * (double(a[v]) + b[v]);
    }
  }
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::fabs(normal[i]) > std::fabs(normal[axis])) axis = i;

  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::vector<Point> points;
  points.reserve(outline.size());
  for (const Vec3 p : outline) points.push_back(normal[axis] >= 0 ? Point{p[u], p[v]} : Point{p[v], p[u]});
  return points;
}

}  // namespace

void triangulate_outline(std::span<const Vec3> outline,
                         std::vector<std::array<std::uint32_t, 3>>& triangles) {
  triangles.clear();
  if (outline.size() < 3) return;
  const std::vector<Point> points = outline.size() > 3 ? flatten(outline) : std::vector<Point>();

  // A polygon that never turns right is convex: every fan fills it.
  bool is_convex = true;
  for (std::size_t i = 0, n = points.size(); i < n && is_convex; ++i)
    is_convex = turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) >= 0;
  if (is_convex || outline.size() > kMostCornersToClip) {
    for (std::uint32_t i = 2; i < outline.size(); ++i) triangles.push_back({0, i - 1, i});
    return;
  }

  // Cut off ears: corners that turn left and whose triangle holds no other corner. Corners in the same place
  // as the triangle's own do not count: the bridge to a hole goes there and back.
  std::vector<std::uint32_t> left(outline.size());
  std::iota(left.begin(), left.end(), 0u);
  std::size_t tip = 1, tried = 0;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    tip %= n;
    const std::uint32_t a = left[(tip + n - 1) % n], b = left[tip], c = left[(tip + 1) % n];
    bool is_ear = turn(points[a], points[b], points[c]) > 0;
    for (std::size_t i = 0; i < n && is_ear; ++i) {
      const Point p = points[left[i]];
      is_ear = p == points[a] || p == points[b] || p == points[c] ||
               !is_inside(p, points[a], points[b], points[c]);
    }
    // A polygon that crosses itself may have no ear; after a full round cut anywhere to come to an end.
    if (!is_ear && ++tried < n) {
      ++tip;
      continue;
    }
    triangles.push_back({a, b, c});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(tip));
    tried = 0;
  }
  triangles.push_back({left[0], left[1], left[2]});
}

void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
                 std::vector<std::array<std::uint32_t, 3>>& triangles) {
  if (corners.size() == 3) {
    triangles.push_back({corners[0], corners[1], corners[2]});
    return;
  }
  std::vector<Vec3> outline;
  for (const std::uint32_t corner : corners) outline.push_back(positions[corner]);
  std::vector<std::array<std::uint32_t, 3>> local;
  triangulate_outline(outline, local);
  for (const auto [a, b, c] : local) triangles.push_back({corners[a], corners[b], corners[c]});
}

}  // namespace boxwood::io
