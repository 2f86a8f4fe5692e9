#include "workload.h"

#include <map>
#include <string>

#include "boxwood/core/random.h"
#include "boxwood/gallery/gallery.h"

namespace boxwood::bench {

const std::vector<Triangle>& triangles(const char* scene) {
  static std::map<std::string, std::vector<Triangle>> made;
  std::vector<Triangle>& out = made[scene];
  if (!out.empty()) return out;

  const SceneDesc desc = gallery::make(scene);
  for (const Instance& instance : placed_instances(desc)) {
    const auto* mesh = std::get_if<TriangleMesh>(&desc.geometries[instance.geometry.value].shapes);
    if (!mesh) continue;
    const Affine3& m = instance.world_from_object;
    for (const auto& [i, j, k] : mesh->indices)
      out.push_back({m.point(mesh->positions[i]), m.point(mesh->positions[j]), m.point(mesh->positions[k])});
  }
  return out;
}

const std::vector<Sphere>& spheres() {
  static const std::vector<Sphere> made = [] {
    std::vector<Sphere> out;
    for (const Geometry& geometry : gallery::make("spheres:100000").geometries)
      if (const auto* balls = std::get_if<std::vector<Sphere>>(&geometry.shapes))
        out.insert(out.end(), balls->begin(), balls->end());
    return out;
  }();
  return made;
}

std::vector<Ray> mixed_rays(const Box3& bounds, std::size_t count) {
  Random random(1);
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 inside = random.in_box(bounds.lower, bounds.upper);
    if (i % 2 == 0) {
      const Vec3 outside = bounds.center() + random.direction() * (2 * length(bounds.extent()));
      rays[i] = {.origin = outside, .direction = normalize(inside - outside)};
    } else {
      rays[i] = {.origin = inside, .direction = random.direction()};
    }
  }
  return rays;
}

std::vector<Ray> shadow_rays(const Box3& bounds, std::size_t count) {
  Random random(2);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    const Vec3 from = random.in_box(bounds.lower, bounds.upper),
               to = random.in_box(bounds.lower, bounds.upper);
    ray = {.origin = from, .direction = to - from, .t_max = 1};
  }
  return rays;
}

}  // namespace boxwood::bench
