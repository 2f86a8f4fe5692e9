#include "boxwood/render/shadow.h"

#include <algorithm>

#include "boxwood/core/every_cpu.h"
#include "boxwood/render/material.h"
#include "boxwood/scene/surface.h"

namespace boxwood::render {
namespace {

/// The share of light that goes straight on at a surface; of a mix, the mean of its parts.
float clear_share(const SceneDesc& desc, MaterialId id, const TexturePoint& point) {
  const Material& material = material_of(desc, id);
  if (material.kind != Material::Kind::mix)
    return is_see_through(material) ? 1 - opacity_at(desc, material, point) : 0;
  const float second = mix_share(desc, material, point);
  return clear_share(desc, material.first, point) * (1 - second) +
         clear_share(desc, material.second, point) * second;
}

constexpr int kMaxSteps = 1024;
/// More boxes than this become one: a ray is held against each.
constexpr std::size_t kMaxVeils = 4;

Box3 box_of(const Geometry& geometry) {
  Box3 box;
  std::visit(
      [&](const auto& shapes) {
        if constexpr (std::is_same_v<std::decay_t<decltype(shapes)>, TriangleMesh>) {
          for (const Vec3 position : shapes.positions) box.extend(position);
        } else {
          for (const auto& shape : shapes) box.extend(shape.box());
        }
      },
      geometry.shapes);
  return box;
}

bool has_see_through(const SceneDesc& desc, const Instance& instance) {
  const auto lets_through = [&](MaterialId id) {
    // Mixes hold materials that stand before them.
    const auto look = [&](const auto& self, MaterialId m) -> bool {
      const Material& material = material_of(desc, m);
      if (material.kind == Material::Kind::mix)
        return self(self, material.first) || self(self, material.second);
      return is_see_through(material);
    };
    return look(look, id);
  };
  if (instance.material.is_valid()) return lets_through(instance.material);
  const Geometry& geometry = desc.geometries[instance.geometry.value];
  if (geometry.materials.empty()) return lets_through(geometry.material);
  return std::any_of(geometry.materials.begin(), geometry.materials.end(), lets_through);
}

}  // namespace

Shadows::Shadows(const Scene& scene) : scene_(scene) {
  const SceneDesc& desc = scene.description();
  for (const Instance& instance : placed_instances(desc)) {
    is_veil_.push_back(has_see_through(desc, instance));
    if (!is_veil_.back()) continue;
    const Geometry& geometry = desc.geometries[instance.geometry.value];
    veils_.push_back(transform_box(instance.world_from_object, box_of(geometry)));
  }
  const Box3 bounds = scene.bounds();
  if (!bounds.is_empty()) reach_ = max_component(max(abs(bounds.lower), abs(bounds.upper)));
  if (veils_.size() <= kMaxVeils) return;
  Box3 all;
  for (const Box3& box : veils_) all.extend(box);
  veils_ = {all};
}

#define BOXWOOD_LOOPS "boxwood/render/shadow-inl.h"
#include "boxwood/core/every_cpu-inl.h"

void Shadows::find_veiled(const RayBlock& rays, Integers& may_meet_veil) const {
  may_meet_veil.fill(0);
  for (const Box3& veil : veils_) BOXWOOD_BEST(meet_boxes)(veil, reach_, rays, may_meet_veil);
}

void Shadows::deliver(AwaitedLight& light, std::span<float> samples, std::span<RayCounts> rays) const {
  const auto add = [&](const AwaitedLight::Light& to, Vec3 transmittance) {
    float* sum = &samples[3 * std::size_t(to.sample)];
    const Vec3 arrived = to.light * transmittance;
    sum[0] += arrived.x;
    sum[1] += arrived.y;
    sum[2] += arrived.z;
  };
  const AwaitedLight::Row &plain = light.plain_, &careful = light.careful_;
  scene_.any_hit(std::span(plain.rays).first(plain.size), {light.is_hidden_.get(), plain.size},
                 &serial_executor());
  for (std::size_t i = 0; i < plain.size; ++i) {
    ++rays[plain.lights[i].sample].shadow;
    if (!light.is_hidden_[i]) add(plain.lights[i], {1, 1, 1});
  }

  scene_.closest_hit(std::span(careful.rays).first(careful.size), std::span(light.hits_).first(careful.size),
                     &serial_executor());
  for (std::size_t i = 0; i < careful.size; ++i) {
    const Hit& hit = light.hits_[i];
    const Ray& ray = careful.rays[i];
    const AwaitedLight::Light& to = careful.lights[i];
    ++rays[to.sample].bounce;
    if (!hit)
      add(to, beer(light.absorption_[i], ray.t_max * length(ray.direction)));
    else if (is_veil_[hit.instance_id.value] != 0)
      add(to, walk(ray, hit, light.absorption_[i], rays[to.sample]));
  }
}

Vec3 Shadows::walk(const Ray& way, const Hit& first_hit, Vec3 absorption, RayCounts& rays) const {
  const SceneDesc& desc = scene_.description();
  const bool has_end = way.t_max < kInfinity;
  const Vec3 end = has_end ? way.at(way.t_max) : Vec3{0, 0, 0};
  Ray ray = way;
  Hit hit = first_hit;
  Vec3 left{1, 1, 1};
  for (int step = 0; step < kMaxSteps; ++step) {
    left *= beer(absorption, min(hit.t, ray.t_max) * length(ray.direction));
    if (!hit) return left;
    const Surface surface = surface_at(scene_, ray, hit);
    const float share = clear_share(desc, surface.material, TexturePoint(scene_, hit, surface));
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
    ++rays.bounce;
    hit = scene_.closest_hit(ray);
  }
  return {0, 0, 0};
}

}  // namespace boxwood::render
