// ladder_rays.h: which rays is the ladder climbed with?
//
// Half of them as a renderer's first rays, from the scene's camera, or one that sees all of it, through
// random points of the picture; half as its next ones: from where such a ray hit, in a random direction. The
// order is random, so that the first k of the set are a fair sample of all; that, and the seed, is fixed.
#pragma once

#include <vector>

#include "boxwood/core/random.h"
#include "boxwood/query/closest_hit.h"
#include "boxwood/scene/description.h"

namespace boxwood::app {

/// `first_hit(ray)` answers with the closest hit's t.
template <class FirstHit>
std::vector<Ray> ladder_rays(const Box3& bounds, const std::optional<Camera>& camera, std::size_t count,
                             const FirstHit& first_hit) {
  Random random(2024);
  const Vec3 center = bounds.center();
  const float radius = max(0.5f * length(bounds.extent()), 1e-30f);

  // Where the first rays start, and how wide they spread.
  Affine3 world_from_camera =
      Affine3::look_at(center + Vec3{0.55f, 0.4f, 0.9f} * (2.4f * radius), center, {0, 1, 0});
  float fov_deg = 45;
  if (camera) {
    world_from_camera = camera->world_from_camera;
    fov_deg = camera->fov_deg;
  }
  const float spread = std::tan(0.5f * fov_deg * 0.01745329252f);
  const auto first_ray = [&] {
    const float x = random.uniform(-spread, spread), y = random.uniform(-spread, spread);
    return Ray{world_from_camera.origin, 0, normalize(world_from_camera.vector({x, y, -1}))};
  };

  std::vector<Ray> rays;
  rays.reserve(count);
  while (rays.size() < count) {
    Ray ray = first_ray();
    if (random.below(2)) {
      // A ray that leaves the scene has no next one: start from any point inside the bounds.
      const float t = first_hit(ray);
      const Vec3 from = t < kInfinity ? ray.at(t) : random.in_box(bounds.lower, bounds.upper);
      ray = {from, 1e-5f * radius, random.direction()};
    }
    rays.push_back(ray);
  }
  return rays;
}

/// Rays that all aim at the middle of one triangle, from around it.
inline std::vector<Ray> rays_at(const Triangle& target, std::size_t count) {
  Random random(2025);
  const Vec3 middle = (target.a + target.b + target.c) / 3;
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.direction = random.direction();
    ray.origin = middle - ray.direction * 4;
  }
  return rays;
}

}  // namespace boxwood::app
