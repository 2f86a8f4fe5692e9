// light.h: where does light come from, and how likely is a sampler to look there?
//
// Next-event estimation: at each point of a path one light is chosen and one point of it tried. The choice
// goes by how much light each could send to that point at most, so that a lamp nearby and the sun get their
// turns wherever they matter. Shapes that emit are gathered into groups, one for each instance; within a
// group a shape is chosen by its power.
//
// The same densities are known for rays that find a light by chance, so that both ways can be weighed
// (multiple importance sampling, Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo
// Rendering", SIGGRAPH 1995). The dome of the sky is found by chance only: it is smooth, and a surface's own
// sampling suits it.
#pragma once

#include <optional>
#include <vector>

#include "boxwood/render/emitter.h"
#include "boxwood/render/sky.h"
#include "boxwood/scene/surface.h"

namespace boxwood::render {

/// One try to reach a light.
struct LightSample {
  Vec3 direction;  ///< Towards the light; unit length.
  Vec3 radiance;   ///< From there, if nothing is in the way; for lights without a surface: what replaces it.
  /// Per solid angle, with the choice of the light; for lights without a surface: of the choice.
  float pdf = 0;
  bool is_perfect = false;  ///< No other way finds this light.
  Ray shadow_ray;           ///< Hits nothing when the light is in sight.
};

/// A point that light falls on, for the choice of a light.
struct Receiver {
  Vec3 position;
  Vec3 normal;  ///< Towards the side that is lit; unit length.
};

class Lights {
 public:
  /// Collects every light of the scene; without any it adds the plain sky. Keeps a reference to `scene`.
  Lights(const Scene& scene, const Camera& camera);

  /// Tries one light from `surface`, which is lit on the side of `facing_normal`. Nothing when no light could
  /// reach it, or the point tried faces away.
  std::optional<LightSample> sample(const Surface& surface, Vec3 facing_normal, float choice, Vec2 u) const;

  /// The radiance of the dome along a ray that hits nothing.
  Vec3 dome(Vec3 direction) const { return sky_ ? sky_radiance(*sky_, direction) : Vec3{}; }

  /// The radiance of the sun, where `direction` (unit length) points into it, and the density with which
  /// sample() finds it.
  Vec3 sun(Vec3 direction, const Receiver& from, float& pdf) const;

  /// The radiance that `surface` sends against `direction`.
  Vec3 emission(const Surface& surface, Vec3 direction) const;

  /// The density, per solid angle, with which sample() finds the point `surface`, which `hit` is on, from
  /// `from`. 0 when it never does.
  float pdf(const Hit& hit, const Surface& surface, Vec3 direction, const Receiver& from) const;

 private:
  /// Any light that can be chosen.
  struct Light {
    enum class Kind { group, point, distant, sun } kind;
    std::uint32_t index = 0;  // of the group, the point light or the distant light
    Vec3 position;            // group: the middle of its box; point light
    Vec3 direction;           // distant and sun: towards it
    float strength = 0;       // brightness: irradiance, at distance 1 where there is a distance
    float min_distance_squared = 0;
    Box3 box;  // group
  };

  float importance(const Light& light, const Receiver& from) const;
  /// Chooses a light, and stretches what is left of `choice` so that it can choose again.
  std::optional<std::uint32_t> choose(const Receiver& from, float& choice, float& probability) const;
  float choice_probability(std::uint32_t light_index, const Receiver& from) const;

  const Scene& scene_;
  std::optional<Sky> sky_;
  std::optional<Sun> sun_;
  std::vector<Light> lights_;
  // The sum of strengths up to each light; for large numbers of lights.
  std::vector<double> running_strength_;
  std::vector<EmitterGroup> groups_;
  std::vector<std::uint32_t> group_of_instance_;  // InstanceId -> groups_; kNoGroup
  std::vector<std::uint32_t> light_of_group_;
  std::uint32_t sun_light_index_ = 0;
};

/// How much a light matters to the eye.
inline float brightness(Vec3 radiance) {
  return 0.2126f * radiance.x + 0.7152f * radiance.y + 0.0722f * radiance.z;
}

}  // namespace boxwood::render
