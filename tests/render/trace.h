// trace.h: what does a path tracer see along one ray, on average?
#pragma once

#include <array>

#include "boxwood/render/path.h"
#include "boxwood/render/warp.h"
#include "boxwood/scene/scene.h"

namespace boxwood::render {

/// The mean radiance along `ray` over `samples` samples.
inline Vec3 mean_radiance(const Scene& scene, const Ray& ray, int samples, int bounces = kMaxBounces) {
  const auto tracer = make_path_tracer(scene, Camera{}, 0, bounces);
  std::array<double, 3> sum{};
  RayCounts rays;
  for (int s = 0; s < samples; ++s) {
    Sampler sampler(7, static_cast<std::uint32_t>(s));
    std::array<float, 3> value{};
    if (!tracer->sample(ray, sampler, value, rays)) continue;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += value[c];
  }
  return {static_cast<float>(sum[0] / samples), static_cast<float>(sum[1] / samples),
          static_cast<float>(sum[2] / samples)};
}

/// A sky of the same radiance everywhere.
inline Sky constant_sky(float radiance) {
  Sky sky;
  sky.zenith = sky.horizon = sky.ground = splat(radiance);
  return sky;
}

inline Material material_of_kind(Material::Kind kind, Vec3 color, float roughness = 0) {
  Material material;
  material.kind = kind;
  material.color = color;
  material.roughness = roughness;
  return material;
}

inline Material lamp(float radiance, bool from_both_sides = false) {
  Material material;
  material.color = {0, 0, 0};
  material.emission = splat(radiance);
  material.emits_from_both_sides = from_both_sides;
  return material;
}

/// A large matte floor, seen straight from above at the origin, under whatever `add` puts over it.
template <class Add>
float floor_radiance(const Add& add, int samples, Vec3 from = {0.01f, 0.5f, 0.02f}) {
  SceneDesc desc;
  const MaterialId matte = desc.add(material_of_kind(Material::Kind::matte, splat(0.5f)));
  desc.add(std::vector<Quad>{{{-50, 0, -50}, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}}}, matte);
  add(desc);
  const Scene scene(std::move(desc));
  return mean_radiance(scene, Ray{from, 0, normalize(-from)}, samples).x;
}

/// Radiance of the floor above for a known irradiance.
inline float lambert(float irradiance) {
  return 0.5f * irradiance / kPi;
}

}  // namespace boxwood::render
