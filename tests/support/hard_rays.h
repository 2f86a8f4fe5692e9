// hard_rays.h: which rays are hard for these shapes?
//
// Aimed at corners and middles, along axes and edges and inside planes, with limits that lie on what is hit,
// and with numbers that are none.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "boxwood/core/random.h"
#include "boxwood/reference/brute_force.h"

namespace boxwood::test {

/// Points that matter to the shapes: corners and middles of their boxes, and whatever the caller adds.
template <class Shape>
std::vector<Vec3> targets_of(const std::vector<Shape>& shapes, std::vector<Vec3> targets, Random& random) {
  for (const Shape& shape : shapes) {
    const Box3 box = shape.box();
    if (box.is_empty()) continue;
    targets.push_back(box.corner(static_cast<int>(random.below(8))));
    targets.push_back(box.center());
  }
  if (targets.empty()) targets.push_back({0, 0, 0});
  return targets;
}

/// Rays that are hard for shapes with these targets inside `bounds`.
inline std::vector<Ray> hard_rays(const std::vector<Vec3>& targets, const Box3& bounds, int count,
                                  Random& random) {
  const Vec3 middle = bounds.is_empty() ? Vec3{} : bounds.center();
  float size = bounds.is_empty() ? 1.0f : max_component(bounds.extent());
  if (!(size > 0)) size = 1;
  const auto target = [&] { return targets[random.below(static_cast<std::uint32_t>(targets.size()))]; };
  const auto around = [&] { return middle + random.in_box(splat(-1), splat(1)) * size; };
  const auto axis = [&] {
    Vec3 d{0, 0, 0};
    d[static_cast<int>(random.below(3))] = random.below(2) ? 1.0f : -1.0f;
    return d;
  };

  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3 a = target(), b = target(), from = around();
    Vec3 in_plane = b - a;
    in_plane[static_cast<int>(random.below(3))] = random.below(2) ? 0.0f : -0.0f;
    rays.push_back({from, 0, random.direction(), kInfinity});  // anywhere
    rays.push_back({from, 0, a - from, kInfinity});            // at a corner or a middle
    rays.push_back({from, 0, (a * 0.5f + b * 0.5f) - from, kInfinity});
    const Vec3 d = axis();
    rays.push_back({a - d * size * 2.0f, 0, d, kInfinity});  // along an axis, exactly through
    rays.push_back({a - in_plane, 0, in_plane, kInfinity});  // inside a face's plane
    rays.push_back({a - (b - a), 0, b - a, kInfinity});      // along an edge
    rays.push_back({a, 0, random.direction(), kInfinity});   // from a surface or a corner
    rays.push_back({a, 0, axis(), kInfinity});
    rays.push_back({from, 0, (a - from) * 1e-20f, kInfinity});  // t runs to 1e20
    rays.push_back({from, random.uniform(0, 1), a - from, random.uniform(0, 2)});
  }
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity}) {
    rays.push_back({{0, bad, 0}, 0, {0, 0, 1}, kInfinity});
    rays.push_back({{0, 0, 0}, 0, {0, bad, 1}, kInfinity});
  }
  rays.push_back({middle, 0, {0, 0, 0}, kInfinity});
  rays.push_back({middle, 0, {-0.0f, 0, -1e-40f}, kInfinity});
  rays.push_back({middle, std::numeric_limits<float>::quiet_NaN(), {0, 0, 1}, kInfinity});
  rays.push_back({middle, 0, {0, 0, 1}, std::numeric_limits<float>::quiet_NaN()});
  rays.push_back({middle, -5, {0, 0, 1}, kInfinity});
  rays.push_back({middle, 2, {0, 0, 1}, 1});
  return rays;
}

/// Adds rays whose limits lie on, just before and just behind something that they hit.
template <class Shape>
void add_limited_rays(std::vector<Ray>& rays, const reference::BruteForce<Shape>& brute, Random& random) {
  std::vector<ShapeHit> hits;
  const std::size_t count = rays.size();
  for (std::size_t i = 0; i < count; i += 3) {
    Ray ray = rays[i];
    brute.all_hits(ray, hits);
    if (hits.empty()) continue;
    const float t = hits[random.below(static_cast<std::uint32_t>(hits.size()))].t;
    switch (random.below(5)) {
      case 0:
        ray.t_max = t;
        break;
      case 1:
        ray.t_min = t;
        break;
      case 2:
        ray.t_min = ray.t_max = t;
        break;
      case 3:
        ray.t_max = std::nextafter(t, -1.0f);
        break;
      case 4:
        ray.t_min = std::nextafter(t, kInfinity);
        break;
    }
    rays.push_back(ray);
  }
}

}  // namespace boxwood::test
