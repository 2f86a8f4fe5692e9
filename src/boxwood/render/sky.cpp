#include "boxwood/render/sky.h"

#include "boxwood/render/warp.h"

namespace boxwood::render {

Vec3 sky_radiance(const Sky& sky, Vec3 direction) {
  const auto smoothstep = [](float x) { return x * x * (3 - 2 * x); };
  const float height = dot(sky.up, direction);
  if (height > 0) return sky.horizon + (sky.zenith - sky.horizon) * smoothstep(min(height, 1.0f));
  // The ground has taken over at 30 degrees below the horizon.
  return sky.horizon + (sky.ground - sky.horizon) * smoothstep(min(-2 * height, 1.0f));
}

float Sun::solid_angle() const {
  return 2 * kPi * versine;
}

bool Sun::contains(Vec3 unit_direction) const {
  // For unit vectors, half of |a - b| squared is 1 - cos; exact where 1 - dot would cancel.
  return 0.5f * length_squared(unit_direction - direction) <= versine;
}

std::optional<Sun> sun_of(const Sky& sky) {
  if (!(max_component(sky.sun_radiance) > 0) || !(sky.sun_angle_deg > 0)) return std::nullopt;
  const double quarter = double(min(sky.sun_angle_deg, 180.0f)) * (3.14159265358979 / 180) / 4;
  const double sine = std::sin(quarter);
  return Sun{sky.sun_direction, sky.sun_radiance, static_cast<float>(2 * sine * sine)};
}

Sky plain_sky(const Camera& camera) {
  Sky sky;
  sky.zenith = {0.40f, 0.44f, 0.50f};
  sky.horizon = {0.52f, 0.53f, 0.55f};
  sky.ground = {0.16f, 0.155f, 0.15f};
  const Affine3& m = camera.world_from_camera;
  sky.sun_direction = normalize(normalize(m.z) + normalize(m.y) * 0.9f - normalize(m.x) * 0.7f);
  sky.sun_angle_deg = 12;
  sky.sun_radiance = {62, 59, 54};
  return sky;
}

}  // namespace boxwood::render
