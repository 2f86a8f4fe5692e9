#include "boxwood/render/light.h"

#include <algorithm>
#include <array>

#include "boxwood/render/material.h"
#include "boxwood/render/warp.h"

namespace boxwood::render {
namespace {

constexpr std::uint32_t kNoGroup = 0xffffffffu;

/// Up to this many lights are weighed for each point that is lit; more of them are chosen by strength alone.
constexpr std::size_t kMaxWeighed = 32;

/// Whether a scene has any light of its own.
bool is_lit(const SceneDesc& desc) {
  if (desc.sky || !desc.point_lights.empty() || !desc.distant_lights.empty()) return true;
  return std::any_of(desc.materials.begin(), desc.materials.end(), is_emissive);
}

/// What is left of a random number after it chose something of width `width`: uniform in [0, 1) again.
float stretch(float left, float width) {
  return width > 0 ? min(max(left / width, 0.0f), 0x1.fffffep-1f) : 0;
}

}  // namespace

Lights::Lights(const Scene& scene, const Camera& camera) : scene_(scene) {
  const SceneDesc& desc = scene.description();
  sky_ = is_lit(desc) ? desc.sky : plain_sky(camera);
  if (sky_) sun_ = sun_of(*sky_);

  // Shapes that shine, a group for each instance.
  const std::vector<Instance> instances = placed_instances(desc);
  group_of_instance_.assign(instances.size(), kNoGroup);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    EmitterGroup group(desc, instances[i]);
    if (group.is_empty()) continue;
    const auto index = static_cast<std::uint32_t>(groups_.size());
    group_of_instance_[i] = index;
    light_of_group_.push_back(static_cast<std::uint32_t>(lights_.size()));
    Light light{Light::Kind::group, index};
    light.box = group.bounds();
    light.position = light.box.center();
    light.strength = group.strength();
    // Inside the group's bounding sphere the distance to its middle says nothing.
    light.min_distance_squared = 0.25f * length_squared(light.box.extent());
    lights_.push_back(light);
    groups_.push_back(std::move(group));
  }

  for (std::size_t i = 0; i < desc.point_lights.size(); ++i) {
    Light light{Light::Kind::point, static_cast<std::uint32_t>(i)};
    light.position = desc.point_lights[i].position;
    light.strength = brightness(desc.point_lights[i].intensity);
    lights_.push_back(light);
  }
  for (std::size_t i = 0; i < desc.distant_lights.size(); ++i) {
    Light light{Light::Kind::distant, static_cast<std::uint32_t>(i)};
    light.direction = -desc.distant_lights[i].direction;
    light.strength = brightness(desc.distant_lights[i].irradiance);
    lights_.push_back(light);
  }
  if (sun_) {
    sun_light_index_ = static_cast<std::uint32_t>(lights_.size());
    Light light{Light::Kind::sun};
    light.direction = sun_->direction;
    light.strength = brightness(sun_->radiance) * sun_->solid_angle();
    lights_.push_back(light);
  }

  double sum = 0;
  for (const Light& light : lights_) running_strength_.push_back(sum += light.strength);
}

/// An estimate of the irradiance that `light` could cause at `from` at most. 0 only where it causes none.
float Lights::importance(const Light& light, const Receiver& from) const {
  switch (light.kind) {
    case Light::Kind::distant:
      return dot(light.direction, from.normal) > 0 ? light.strength : 0;
    case Light::Kind::sun: {
      // The sun's upper rim may look over the horizon of the surface while its middle is below.
      const float rim = std::sqrt(sun_->versine * (2 - sun_->versine));
      return dot(light.direction, from.normal) > -rim || sun_->versine >= 1 ? light.strength : 0;
    }
    case Light::Kind::point: {
      const Vec3 to_light = light.position - from.position;
      return dot(to_light, from.normal) > 0 ? light.strength / max(length_squared(to_light), 1e-30f) : 0;
    }
    case Light::Kind::group:
      break;
  }
  // The corner of the box farthest along the normal tells whether any of it is above the surface.
  const Vec3 highest{from.normal.x > 0 ? light.box.upper.x : light.box.lower.x,
                     from.normal.y > 0 ? light.box.upper.y : light.box.lower.y,
                     from.normal.z > 0 ? light.box.upper.z : light.box.lower.z};
  if (!(dot(highest - from.position, from.normal) > 0)) return 0;
  return light.strength /
         max(max(length_squared(light.position - from.position), light.min_distance_squared), 1e-30f);
}

std::optional<std::uint32_t> Lights::choose(const Receiver& from, float& choice, float& probability) const {
  if (lights_.empty()) return std::nullopt;
  if (lights_.size() > kMaxWeighed) {
    const double target = choice * running_strength_.back();
    const auto found = std::upper_bound(running_strength_.begin(), running_strength_.end(), target);
    const auto index = std::min<std::size_t>(static_cast<std::size_t>(found - running_strength_.begin()),
                                             lights_.size() - 1);
    const double before = index > 0 ? running_strength_[index - 1] : 0;
    choice = stretch(static_cast<float>(target - before), lights_[index].strength);
    probability = choice_probability(static_cast<std::uint32_t>(index), from);
    return static_cast<std::uint32_t>(index);
  }

  std::array<float, kMaxWeighed> weights;
  float sum = 0;
  for (std::size_t i = 0; i < lights_.size(); ++i) sum += weights[i] = importance(lights_[i], from);
  if (!(sum > 0) || !(sum < kInfinity)) return std::nullopt;
  float left = choice * sum;
  std::size_t index = 0, last = 0;
  for (; index < lights_.size(); ++index) {
    if (!(weights[index] > 0)) continue;
    last = index;
    if (left < weights[index]) break;
    left -= weights[index];
  }
  choice = stretch(left, weights[last]);
  probability = weights[last] / sum;
  return static_cast<std::uint32_t>(last);
}

float Lights::choice_probability(std::uint32_t light_index, const Receiver& from) const {
  const Light& chosen = lights_[light_index];
  if (lights_.size() > kMaxWeighed) return static_cast<float>(chosen.strength / running_strength_.back());
  float sum = 0;
  for (const Light& light : lights_) sum += importance(light, from);
  return sum > 0 && sum < kInfinity ? importance(chosen, from) / sum : 0;
}

std::optional<LightSample> Lights::sample(const Surface& surface, Vec3 facing_normal, float choice,
                                          Vec2 u) const {
  const Receiver from{surface.position, facing_normal};
  float probability = 0;
  const std::optional<std::uint32_t> index = choose(from, choice, probability);
  if (!index || !(probability > 0)) return std::nullopt;
  const Light& light = lights_[*index];
  const SceneDesc& desc = scene_.description();

  LightSample sample;
  sample.pdf = probability;
  switch (light.kind) {
    case Light::Kind::group: {
      const EmitterPoint point = groups_[light.index].sample(surface.position, choice, u);
      const Vec3 to_light = point.surface.position - surface.position;
      const float distance_squared = length_squared(to_light);
      sample.direction = to_light / std::sqrt(distance_squared);
      const float cosine = -dot(sample.direction, point.surface.normal);
      if (!(point.emits_from_both_sides ? std::fabs(cosine) > 0 : cosine > 0)) return std::nullopt;
      sample.radiance = point.radiance;
      sample.pdf *= point.pdf_area * distance_squared / std::fabs(cosine);
      // End just before the light itself: where a ray from the light would start.
      sample.shadow_ray = surface.spawn(sample.direction);
      sample.shadow_ray.direction = point.surface.spawn(-sample.direction).origin - sample.shadow_ray.origin;
      sample.shadow_ray.t_max = 1;
      break;
    }
    case Light::Kind::point: {
      const Vec3 to_light = light.position - surface.position;
      const float distance_squared = length_squared(to_light);
      sample.direction = to_light / std::sqrt(distance_squared);
      sample.radiance = desc.point_lights[light.index].intensity / distance_squared;
      sample.is_perfect = true;
      sample.shadow_ray = surface.spawn(sample.direction);
      sample.shadow_ray.direction = light.position - sample.shadow_ray.origin;
      sample.shadow_ray.t_max = 1;
      break;
    }
    case Light::Kind::distant:
      sample.direction = light.direction;
      sample.radiance = desc.distant_lights[light.index].irradiance;
      sample.is_perfect = true;
      sample.shadow_ray = surface.spawn(sample.direction);
      break;
    case Light::Kind::sun:
      sample.direction = normalize(Frame(sun_->direction).to_world(uniform_cone(u, sun_->versine)));
      sample.radiance = sun_->radiance;
      sample.pdf /= sun_->solid_angle();
      sample.shadow_ray = surface.spawn(sample.direction);
      break;
  }
  if (!(sample.pdf > 0) || !(sample.pdf < kInfinity) || !is_finite(sample.direction)) return std::nullopt;
  return sample;
}

Vec3 Lights::sun(Vec3 direction, const Receiver& from, float& pdf) const {
  pdf = 0;
  if (!sun_ || !sun_->contains(direction)) return {};
  pdf = choice_probability(sun_light_index_, from) / sun_->solid_angle();
  return sun_->radiance;
}

Vec3 Lights::emission(const Surface& surface, Vec3 direction) const {
  const Material& material = material_of(scene_.description(), surface.material);
  const bool is_front = dot(surface.normal, direction) < 0;
  return is_front || material.emits_from_both_sides ? material.emission : Vec3{};
}

float Lights::pdf(const Hit& hit, const Surface& surface, Vec3 direction, const Receiver& from) const {
  const std::uint32_t group = group_of_instance_[hit.instance_id.value];
  if (group == kNoGroup) return 0;
  const float cosine = std::fabs(dot(surface.normal, direction));
  if (!(cosine > 0)) return 0;
  const float pdf_area = groups_[group].pdf_area(hit.primitive_id, hit.part, surface.position, from.position);
  return choice_probability(light_of_group_[group], from) * pdf_area *
         length_squared(surface.position - from.position) / cosine;
}

}  // namespace boxwood::render
