#include "boxwood/render/light.h"

#include <algorithm>
#include <array>

#include "boxwood/render/material.h"
#include "boxwood/render/warp.h"

namespace boxwood::render {
namespace {

constexpr std::uint32_t kNoGroup = 0xffffffffu;

/// A spot light's share of its intensity at an angle from the axis: none outside, smooth in between.
float spot_falloff(const SpotLight& light, float cosine) {
  if (cosine >= light.inner_cosine) return 1;
  if (cosine <= light.outer_cosine) return 0;
  const float x = (cosine - light.outer_cosine) / (light.inner_cosine - light.outer_cosine);
  return x * x * (3 - 2 * x);
}

/// A ray from `surface` that ends at a point without a surface.
Ray ray_to_point(const Surface& surface, Vec3 direction, Vec3 point) {
  Ray ray = surface.spawn(direction);
  ray.direction = point - ray.origin;
  ray.t_max = 1;
  return ray;
}

float kept_in_unit(float x) {
  return min(max(x, 0.0f), 0x1.fffffep-1f);
}

}  // namespace

bool has_light(const SceneDesc& desc) {
  if (desc.sky || !desc.point_lights.empty() || !desc.spot_lights.empty() || !desc.distant_lights.empty() ||
      !desc.environments.empty())
    return true;
  return desc.is_lit_by_glow && std::any_of(desc.materials.begin(), desc.materials.end(), is_emissive);
}

Lights::Lights(const Scene& scene, const Camera& camera) : scene_(scene) {
  const SceneDesc& desc = scene.description();
  sky_ = has_light(desc) ? desc.sky : plain_sky(camera);
  if (sky_) sun_ = sun_of(*sky_);

  // Lights from far away.
  for (std::size_t i = 0; i < desc.distant_lights.size(); ++i)
    far_lights_.push_back({Far::Kind::distant, static_cast<std::uint32_t>(i),
                           -desc.distant_lights[i].direction, brightness(desc.distant_lights[i].irradiance)});
  if (sun_)
    far_lights_.push_back(
        {Far::Kind::sun, 0, sun_->direction, brightness(sun_->radiance) * sun_->solid_angle()});
  for (const Environment& environment : desc.environments) {
    environments_.emplace_back(environment);
    far_lights_.push_back({Far::Kind::environment,
                           static_cast<std::uint32_t>(environments_.size() - 1),
                           {},
                           environments_.back().strength()});
  }

  // Lights that stand somewhere: shapes that shine, a group for each instance, and points.
  const std::vector<Instance> instances = placed_instances(desc);
  group_of_instance_.assign(instances.size(), kNoGroup);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    EmitterGroup group(desc, instances[i]);
    if (group.size() == 0) continue;
    const auto index = static_cast<std::uint32_t>(groups_.size());
    group_of_instance_[i] = index;
    first_of_group_.push_back(static_cast<std::uint32_t>(near_lights_.size()));
    for (std::uint32_t e = 0; e < group.size(); ++e)
      add_near({Near::Kind::emitter, index, e}, group.bounds(e));
    groups_.push_back(std::move(group));
  }
  for (std::uint32_t i = 0; i < desc.point_lights.size(); ++i) {
    LightBounds bounds;
    bounds.box.extend(desc.point_lights[i].position);
    bounds.strength = brightness(desc.point_lights[i].intensity);
    add_near({Near::Kind::point, 0, i}, bounds);
  }
  for (std::uint32_t i = 0; i < desc.spot_lights.size(); ++i) {
    const SpotLight& spot = desc.spot_lights[i];
    LightBounds bounds;
    bounds.box.extend(spot.position);
    bounds.strength = brightness(spot.intensity);
    bounds.axis = spot.direction;
    bounds.cos_facing = spot.inner_cosine;
    bounds.cos_spread = std::cos(std::acos(min(max(spot.outer_cosine, -1.0f), 1.0f)) -
                                 std::acos(min(max(spot.inner_cosine, -1.0f), 1.0f)) + 1e-3f);
    add_near({Near::Kind::spot, 0, i}, bounds);
  }
  for (const Near& light : near_lights_) {
    const bool is_emitter = light.kind == Near::Kind::emitter;
    const auto flat = is_emitter ? groups_[light.group].flat_light(light.index) : std::nullopt;
    flat_lights_.push_back(flat.value_or(FlatLight{}));
    is_flat_.push_back(flat.has_value());
  }
  tree_ = LightTree(near_bounds_);
  near_bounds_ = {};
}

void Lights::add_near(const Near& light, const LightBounds& bounds) {
  near_lights_.push_back(light);
  near_bounds_.push_back(bounds);
}

/// An estimate of the irradiance that `light` could cause at `from` at most. 0 only where it causes none.
float Lights::importance(const Far& light, const Receiver& from) const {
  if (!(length_squared(from.normal) > 0)) return light.strength;
  switch (light.kind) {
    case Far::Kind::distant:
      return dot(light.direction, from.normal) > 0 ? light.strength : 0;
    case Far::Kind::sun: {
      // The sun's upper rim may look over the horizon of the surface while its middle is below.
      const float rim = std::sqrt(sun_->versine * (2 - sun_->versine));
      return dot(light.direction, from.normal) > -rim || sun_->versine >= 1 ? light.strength : 0;
    }
    case Far::Kind::environment:
      break;
  }
  return light.strength;
}

float Lights::sum_of_importances(const Receiver& from) const {
  return sum_with_far(tree_.importance(from), from);
}

/// `sum`, and the importances of the lights from far away.
float Lights::sum_with_far(float sum, const Receiver& from) const {
  for (const Far& light : far_lights_) sum += importance(light, from);
  return sum;
}

/// The light from far away that `number` falls to, below the sum of all weights; null for the tree. What is
/// left of the number chooses again; `weight` is that of the light.
const Lights::Far* Lights::choose_far(const Receiver& from, float& number, float& weight) const {
  for (const Far& light : far_lights_) {
    weight = importance(light, from);
    if (number < weight) return &light;
    number -= weight;
  }
  return nullptr;
}

std::optional<LightSample> Lights::sample(const Surface& surface, Vec3 facing_normal, float choice,
                                          Vec2 u) const {
  const Receiver from{surface.position, facing_normal};
  if (far_lights_.empty()) {
    const std::optional<LightTree::Choice> chosen = tree_.choose(from, choice);
    return chosen ? sample_near(near_lights_[chosen->light], surface, chosen->probability, u) : std::nullopt;
  }
  const float sum = sum_of_importances(from);
  if (!(sum > 0) || !(sum < kInfinity)) return std::nullopt;

  // One of the lights from far away, or the tree. What is left of the choice chooses again.
  float left = choice * sum, weight = 0;
  if (const Far* light = choose_far(from, left, weight)) return sample_far(*light, surface, weight / sum, u);
  weight = tree_.importance(from);
  if (!(weight > 0)) return std::nullopt;
  float rest = kept_in_unit(left / weight);
  const std::optional<LightTree::Choice> chosen = tree_.choose(from, rest);
  if (!chosen) return std::nullopt;
  return sample_near(near_lights_[chosen->light], surface, chosen->probability * weight / sum, u);
}

void Lights::sample(const SurfaceBlock& surfaces, int count, const Receivers& from, Floats& choices,
                    const Vec2s& u, LightSamples& out) const {
  BlockWeights root;
  if (!tree_.is_empty()) tree_.weigh_root(from, root);

  // One of the lights from far away, or the tree.
  std::array<const Far*, kBlock> far{};
  Floats far_probability{}, tree_weight{}, sums{};
  for (int i = 0; i < count && !far_lights_.empty(); ++i) {
    const Receiver at{from.position[i], from.normal[i]};
    const float sum = sums[i] = sum_with_far(root.sum[i], at);
    if (!(sum > 0) || !(sum < kInfinity)) continue;
    float left = choices[i] * sum, weight = 0;
    far[i] = choose_far(at, left, weight);
    far_probability[i] = weight / sum;
    tree_weight[i] = root.sum[i];
    choices[i] = kept_in_unit(left / root.sum[i]);
  }

  // A light of the tree, and a point of it; most are flat.
  Integers lights{};
  Floats probabilities{};
  if (!tree_.is_empty()) {
    tree_.choose(from, count, root, choices, lights, probabilities);
    for (int i = 0; i < count && !far_lights_.empty(); ++i)
      probabilities[i] = sums[i] < kInfinity ? probabilities[i] * tree_weight[i] / sums[i] : 0;
    sample_flat_lights(flat_lights_, lights, probabilities, surfaces, u, out);
  }

  // The others, one by one.
  for (int i = 0; i < count; ++i) {
    const bool is_near = far[i] == nullptr && probabilities[i] > 0;
    if (is_near && is_flat_[lights[i]]) continue;
    out.pdf[i] = 0;
    if (far[i] == nullptr && !is_near) continue;
    const std::optional<LightSample> found =
        is_near ? sample_near(near_lights_[lights[i]], surfaces[i], probabilities[i], u[i])
                : sample_far(*far[i], surfaces[i], far_probability[i], u[i]);
    if (found) out.set(i, *found);
  }
}

std::optional<LightSample> Lights::sample_far(const Far& light, const Surface& surface, float probability,
                                              Vec2 u) const {
  LightSample sample;
  sample.pdf = probability;
  switch (light.kind) {
    case Far::Kind::distant:
      sample.direction = light.direction;
      sample.radiance = scene_.description().distant_lights[light.index].irradiance;
      sample.is_perfect = true;
      break;
    case Far::Kind::sun:
      sample.direction = normalize(Frame(sun_->direction).to_world(uniform_cone(u, sun_->versine)));
      sample.radiance = sun_->radiance;
      sample.pdf /= sun_->solid_angle();
      break;
    case Far::Kind::environment: {
      const EnvironmentLight& environment = environments_[light.index];
      const EnvironmentLight::Sample found = environment.sample(u);
      sample.direction = found.direction;
      sample.radiance = environment.radiance(found.direction);
      sample.pdf *= found.pdf;
      break;
    }
  }
  sample.shadow_ray = surface.spawn(sample.direction);
  if (!(sample.pdf > 0) || !(sample.pdf < kInfinity) || !is_finite(sample.direction)) return std::nullopt;
  return sample;
}

std::optional<LightSample> Lights::sample_near(const Near& light, const Surface& surface, float probability,
                                               Vec2 u) const {
  const SceneDesc& desc = scene_.description();
  LightSample sample;
  sample.pdf = probability;
  switch (light.kind) {
    case Near::Kind::emitter: {
      const EmitterPoint point = groups_[light.group].sample(light.index, surface.position, u);
      const Vec3 to_light = point.position - surface.position;
      const float distance_squared = length_squared(to_light);
      sample.direction = to_light / std::sqrt(distance_squared);
      const float cosine = -dot(sample.direction, point.normal);
      if (!(point.emits_from_both_sides ? std::fabs(cosine) > 0 : cosine > 0)) return std::nullopt;
      sample.radiance = point.radiance;
      sample.pdf *= point.pdf_area * distance_squared / std::fabs(cosine);
      // End just before the light itself: where a ray from the light would start.
      const float clearance = cosine > 0 ? point.clearance : -point.clearance;
      sample.shadow_ray = ray_to_point(surface, sample.direction, point.position + point.normal * clearance);
      break;
    }
    case Near::Kind::point:
    case Near::Kind::spot: {
      const bool is_point = light.kind == Near::Kind::point;
      const Vec3 position =
          is_point ? desc.point_lights[light.index].position : desc.spot_lights[light.index].position;
      const Vec3 to_light = position - surface.position;
      const float distance_squared = length_squared(to_light);
      sample.direction = to_light / std::sqrt(distance_squared);
      sample.radiance =
          is_point ? desc.point_lights[light.index].intensity
                   : desc.spot_lights[light.index].intensity *
                         spot_falloff(desc.spot_lights[light.index],
                                      -dot(sample.direction, desc.spot_lights[light.index].direction));
      sample.radiance = sample.radiance / distance_squared;
      sample.is_perfect = true;
      sample.shadow_ray = ray_to_point(surface, sample.direction, position);
      break;
    }
  }
  if (!(sample.pdf > 0) || !(sample.pdf < kInfinity) || !is_finite(sample.direction)) return std::nullopt;
  return sample;
}

Lights::FarLight Lights::far_light(std::size_t index, Vec3 direction, const Receiver& from) const {
  const Far& light = far_lights_[index];
  FarLight found{{0, 0, 0}, 0};
  if (light.kind == Far::Kind::sun && sun_->contains(direction)) {
    found = {sun_->radiance, 1 / sun_->solid_angle()};
  } else if (light.kind == Far::Kind::environment) {
    const EnvironmentLight& environment = environments_[light.index];
    found = {environment.radiance(direction), environment.pdf(direction)};
  }
  if (!(max_component(found.radiance) > 0)) return {{0, 0, 0}, 0};
  const float sum = sum_of_importances(from);
  found.pdf *= sum > 0 && sum < kInfinity ? importance(light, from) / sum : 0;
  return found;
}

Vec3 Lights::emission(const Surface& surface, Vec3 direction) const {
  const Material& material = material_of(scene_.description(), surface.material);
  const bool is_front = dot(surface.normal, direction) < 0;
  if (!is_emissive(material) || (!is_front && !material.emits_from_both_sides)) return {};
  return emission_at(scene_.description(), material, TexturePoint(surface));
}

float Lights::pdf(const Hit& hit, const Surface& surface, Vec3 direction, const Receiver& from) const {
  const std::uint32_t group = group_of_instance_[hit.instance_id.value];
  if (group == kNoGroup) return 0;
  const float cosine = std::fabs(dot(surface.normal, direction));
  const std::optional<std::uint32_t> emitter = groups_[group].find(hit.primitive_id, hit.part);
  if (!(cosine > 0) || !emitter) return 0;
  float probability = tree_.probability(first_of_group_[group] + *emitter, from);
  if (!far_lights_.empty()) {
    const float sum = sum_of_importances(from);
    if (!(sum > 0) || !(sum < kInfinity)) return 0;
    probability *= tree_.importance(from) / sum;
  }
  return probability * groups_[group].pdf_area(*emitter, surface.position, from.position) *
         length_squared(surface.position - from.position) / cosine;
}

}  // namespace boxwood::render
