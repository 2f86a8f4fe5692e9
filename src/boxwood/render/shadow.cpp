#include "boxwood/render/shadow.h"

#include <algorithm>

#include "boxwood/render/block.h"
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

/// Rays of a block.
struct RayBlock {
  Vec3s origin, direction;
  Floats t_max{};

  void set(int i, const Ray& ray) {
    origin.set(i, ray.origin);
    direction.set(i, ray.direction);
    t_max[i] = ray.t_max;
  }
};

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

void Shadows::find_veiled(std::span<const Way> ways, std::span<char> is_veiled) const {
  const auto loop = has_avx2() ? avx2::meet_boxes : everywhere::meet_boxes;
  RayBlock block;
  for (std::size_t first = 0; first < ways.size(); first += kBlock) {
    const std::size_t count = std::min<std::size_t>(kBlock, ways.size() - first);
    for (std::size_t i = 0; i < count; ++i) block.set(static_cast<int>(i), ways[first + i].ray);
    Integers meets{};
    for (const Box3& veil : veils_) loop(veil, reach_, block, meets);
    for (std::size_t i = 0; i < count; ++i) is_veiled[first + i] = meets[i] != 0;
  }
}

void Shadows::transmittances(std::span<const Way> ways, std::span<Vec3> out, RayCounts& rays) const {
  std::vector<Ray> plain, veiled;
  std::vector<char> is_veiled(ways.size());
  plain.reserve(ways.size());
  find_veiled(ways, is_veiled);
  for (std::size_t i = 0; i < ways.size(); ++i) (is_veiled[i] ? veiled : plain).push_back(ways[i].ray);
  const std::unique_ptr<bool[]> is_hidden(new bool[plain.size()]);
  scene_.any_hit(plain, {is_hidden.get(), plain.size()}, &serial_executor());
  std::vector<Hit> hits(veiled.size());
  scene_.closest_hit(veiled, hits, &serial_executor());
  rays.shadow += plain.size();
  rays.bounce += veiled.size();

  std::size_t next_plain = 0, next_veiled = 0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const Way& way = ways[i];
    const Hit* hit = is_veiled[i] ? &hits[next_veiled++] : nullptr;
    const bool is_clear = hit != nullptr ? !hit->is_hit() : !is_hidden[next_plain++];
    if (is_clear)
      out[i] = max_component(way.absorption) > 0
                   ? beer(way.absorption, way.ray.t_max * length(way.ray.direction))
                   : Vec3{1, 1, 1};
    else if (hit != nullptr && is_veil_[hit->instance_id.value] != 0)
      out[i] = walk(way, *hit, rays);
    else
      out[i] = {0, 0, 0};
  }
}

Vec3 Shadows::walk(const Way& way, const Hit& first_hit, RayCounts& rays) const {
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
    ++rays.bounce;
    hit = scene_.closest_hit(ray);
  }
  return {0, 0, 0};
}

}  // namespace boxwood::render
