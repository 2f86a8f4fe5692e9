#include "boxwood/render/shadow.h"

#include <algorithm>

#include "boxwood/render/material.h"
#include "boxwood/scene/surface.h"

namespace boxwood::render {
namespace {

/// The share of light that goes straight on at a surface; of a mix, the mean of its parts.
float clear_share(const SceneDesc& desc, MaterialId id, Vec2 uv) {
  const Material& material = material_of(desc, id);
  if (material.kind != Material::Kind::mix)
    return is_see_through(material) ? 1 - opacity_at(desc, material, uv) : 0;
  const float second = mix_share(desc, material, uv);
  return clear_share(desc, material.first, uv) * (1 - second) +
         clear_share(desc, material.second, uv) * second;
}

constexpr int kMaxSteps = 1024;

}  // namespace

Shadows::Shadows(const Scene& scene) : scene_(scene) {
  const std::vector<Material>& materials = scene.description().materials;
  has_see_through_ = std::any_of(materials.begin(), materials.end(), is_see_through);
}

Vec3 Shadows::transmittance(const Ray& shadow_ray, bool is_hidden, Vec3 absorption,
                            std::uint64_t& rays) const {
  const float size = length(shadow_ray.direction);
  if (!is_hidden)
    return max_component(absorption) > 0 ? beer(absorption, shadow_ray.t_max * size) : Vec3{1, 1, 1};
  if (!has_see_through_) return {0, 0, 0};

  const SceneDesc& desc = scene_.description();
  const bool has_end = shadow_ray.t_max < kInfinity;
  const Vec3 end = has_end ? shadow_ray.at(shadow_ray.t_max) : Vec3{0, 0, 0};
  Ray ray = shadow_ray;
  Vec3 left{1, 1, 1};
  for (int step = 0; step < kMaxSteps; ++step) {
    ++rays;
    const Hit hit = scene_.closest_hit(ray);
    left *= beer(absorption, min(hit.t, ray.t_max) * length(ray.direction));
    if (!hit) return left;
    const Surface surface = surface_at(scene_, ray, hit);
    const float share = clear_share(desc, surface.material, surface.uv);
    if (!(share > 0) || !(max_component(left) > 0)) return {0, 0, 0};
    left *= share;

    // Behind the surface the medium may be another.
    const Material& material = material_of(desc, surface.material);
    if (material.kind == Material::Kind::clear)
      absorption = dot(ray.direction, surface.normal) < 0 ? material.absorption : material.outer_absorption;
    const Vec3 along = ray.direction;
    ray = surface.spawn(along);
    if (has_end) {
      ray.direction = end - ray.origin;
      ray.t_max = 1;
      if (!(dot(ray.direction, along) > 0)) return left;  // the surface is where the light is
    }
  }
  return {0, 0, 0};
}

}  // namespace boxwood::render
