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

void Shadows::transmittances(std::span<const Way> ways, std::span<const bool> is_hidden, std::span<Vec3> out,
                             std::uint64_t& rays) const {
  std::vector<Ray> hidden;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const Way& way = ways[i];
    if (is_hidden[i]) {
      out[i] = {0, 0, 0};
      if (has_see_through_) hidden.push_back(way.ray);
    } else {
      out[i] = max_component(way.absorption) > 0
                   ? beer(way.absorption, way.ray.t_max * length(way.ray.direction))
                   : Vec3{1, 1, 1};
    }
  }
  if (hidden.empty()) return;

  // What is in the way? Mostly something opaque, and that is that.
  std::vector<Hit> hits(hidden.size());
  scene_.closest_hit(hidden, hits, &serial_executor());
  rays += hidden.size();
  for (std::size_t i = 0, h = 0; i < ways.size(); ++i)
    if (is_hidden[i]) out[i] = walk(ways[i], hits[h++], rays);
}

Vec3 Shadows::walk(const Way& way, const Hit& first_hit, std::uint64_t& rays) const {
  const SceneDesc& desc = scene_.description();
  const bool has_end = way.ray.t_max < kInfinity;
  const Vec3 end = has_end ? way.ray.at(way.ray.t_max) : Vec3{0, 0, 0};
  Ray ray = way.ray;
  Hit hit = first_hit;
  Vec3 left{1, 1, 1}, absorption = way.absorption;
  for (int step = 0; step < kMaxSteps; ++step) {
    left *= beer(absorption, min(hit.t, ray.t_max) * length(ray.direction));
    if (!hit) return left;
    const Surface surface = surface_at(scene_, ray, hit);
    const float share = clear_share(desc, surface.material, surface.uv);
    if (!(share > 0) || !(max_component(left) > 0)) return {0, 0, 0};
    left *= share;

    // Behind the surface the medium may be another.
    const Material& material = material_of(desc, surface.material);
    if (is_see_through(material))
      absorption = dot(ray.direction, surface.normal) < 0 ? material.absorption : material.outer_absorption;
    const Vec3 along = ray.direction;
    ray = surface.spawn(along);
    if (has_end) {
      ray.direction = end - ray.origin;
      ray.t_max = 1;
      if (!(dot(ray.direction, along) > 0)) return left;  // the surface is where the light is
    }
    ++rays;
    hit = scene_.closest_hit(ray);
  }
  return {0, 0, 0};
}

}  // namespace boxwood::render
