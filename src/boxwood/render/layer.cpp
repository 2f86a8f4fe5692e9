#include "boxwood/render/layer.h"

#include <array>
#include <optional>
#include <stdexcept>

#include "boxwood/render/material.h"
#include "boxwood/scene/surface.h"

namespace boxwood::render {
namespace {

enum class Kind { mean, name, tally };

struct LayerFacts {
  Layer layer;
  std::string_view name;
  Kind kind;
  std::array<std::string_view, 3> channels;  // behind the layer's name and a dot; "" for none
};
constexpr LayerFacts kFacts[] = {{Layer::albedo, "albedo", Kind::mean, {"R", "G", "B"}},
                                 {Layer::normal, "normal", Kind::mean, {"X", "Y", "Z"}},
                                 {Layer::depth, "depth", Kind::mean, {"Z"}},
                                 {Layer::position, "position", Kind::mean, {"X", "Y", "Z"}},
                                 {Layer::object, "object", Kind::name, {"id"}},
                                 {Layer::material, "material", Kind::name, {"id"}},
                                 {Layer::samples, "samples", Kind::tally, {"count"}},
                                 {Layer::variance, "variance", Kind::tally, {"Y"}}};
constexpr Layer kLayers[] = {Layer::albedo, Layer::normal,   Layer::depth,   Layer::position,
                             Layer::object, Layer::material, Layer::samples, Layer::variance};

const LayerFacts& facts_of(Layer layer) {
  return kFacts[static_cast<std::size_t>(layer)];
}

/// What a camera ray gets to see.
struct Seen {
  Surface surface;
  Hit hit;
  float distance;  // from the ray's start; directions are of unit length
};

/// The first surface that meets at least half of the light; cut-outs and veils are seen through. `hit` is the
/// ray's first.
std::optional<Seen> first_seen(const Scene& scene, Ray ray, Hit hit) {
  constexpr int kMaxVeils = 64;
  const SceneDesc& desc = scene.description();
  float before = 0;
  for (int veil = 0; hit && veil < kMaxVeils; ++veil) {
    const Surface surface = surface_at(scene, ray, hit);
    const Material& material = material_of(desc, surface.material);
    const bool is_seen =
        !is_see_through(material) || (material.kind != Material::Kind::clear &&
                                      opacity_at(desc, material, TexturePoint(scene, hit, surface)) >= 0.5f);
    if (is_seen) return Seen{surface, hit, before + hit.t};
    before += hit.t;
    ray = surface.spawn(ray.direction);
    hit = scene.closest_hit(ray);
  }
  return std::nullopt;
}

}  // namespace

std::span<const Layer> all_layers() {
  return kLayers;
}

std::string_view layer_name(Layer layer) {
  return facts_of(layer).name;
}

Layer layer_from_name(std::string_view name) {
  std::string known;
  for (const LayerFacts& facts : kFacts) {
    if (facts.name == name) return facts.layer;
    known += (known.empty() ? "" : ", ") + std::string(facts.name);
  }
  throw std::invalid_argument("'" + std::string(name) + "' is not a layer; expected some of " + known);
}

std::vector<std::string> layer_channels(Layer layer) {
  std::vector<std::string> names;
  for (const std::string_view channel : facts_of(layer).channels)
    if (!channel.empty()) names.push_back(std::string(layer_name(layer)) + "." + std::string(channel));
  return names;
}

bool is_mean(Layer layer) {
  return facts_of(layer).kind == Kind::mean;
}

bool is_name(Layer layer) {
  return facts_of(layer).kind == Kind::name;
}

Features::Features(const Scene& scene, std::span<const Layer> layers) : scene_(scene) {
  for (const Layer layer : layers) {
    if (!is_mean(layer)) continue;
    layers_.push_back(layer);
    channels_ += layer_channels(layer).size();
  }
}

void Features::look(std::span<const Ray> rays, std::span<float> values, std::span<bool> is_hit) const {
  std::vector<Hit> hits(rays.size());
  scene_.closest_hit(rays, hits, &serial_executor());
  const SceneDesc& desc = scene_.description();
  float* out = values.data();
  const auto put = [&out](Vec3 v) {
    for (int c = 0; c < 3; ++c) *out++ = v[c];
  };
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::optional<Seen> seen = first_seen(scene_, rays[i], hits[i]);
    is_hit[i] = seen.has_value();
    for (const Layer layer : layers_) {
      if (layer == Layer::depth)
        *out++ = seen ? seen->distance : 0;
      else if (!seen)
        put({0, 0, 0});
      else if (layer == Layer::albedo)
        put(base_color(desc, material_of(desc, seen->surface.material),
                       TexturePoint(scene_, seen->hit, seen->surface)));
      else
        put(layer == Layer::normal ? seen->surface.shading_normal : seen->surface.position);
    }
  }
}

float name_of_hit(const Scene& scene, const Ray& ray, Layer layer) {
  const std::optional<Seen> seen = first_seen(scene, ray, scene.closest_hit(ray));
  if (!seen) return 0;
  if (layer == Layer::object) return static_cast<float>(seen->hit.instance_id.value + 1);
  return seen->surface.material.is_valid() ? static_cast<float>(seen->surface.material.value + 1) : 0;
}

}  // namespace boxwood::render
