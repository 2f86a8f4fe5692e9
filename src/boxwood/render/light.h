// light.h: where does light come from, and how likely is a sampler to look there?
//
// Next-event estimation: at each point of a path one light is chosen and one point of it tried. The choice
// goes by how much light each could send to that point at most: lights that stand somewhere are chosen by
// their tree (light_tree.h), and the whole tree and each light from far away (a distant light, the sun, a
// picture of the surroundings) by their irradiance.
//
// The same densities are known for rays that find a light by chance, so that both ways can be weighed
// (multiple importance sampling, Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo
// Rendering", SIGGRAPH 1995). The dome of the sky is found by chance only: it is smooth, and a surface's own
// sampling suits it.
#pragma once

#include <optional>
#include <vector>

#include "boxwood/render/emitter.h"
#include "boxwood/render/environment.h"
#include "boxwood/render/light_sample.h"
#include "boxwood/render/sky.h"
#include "boxwood/scene/surface_block.h"

namespace boxwood::render {

/// Whether a scene has any light of its own.
bool has_light(const SceneDesc& desc);

class Lights {
 public:
  /// Collects every light of the scene; without any it adds the plain sky. Keeps a reference to `scene`.
  Lights(const Scene& scene, const Camera& camera);

  /// Tries one light from `surface`, which is lit on the side of `facing_normal`, or on both when that is
  /// zero. Nothing when no light could reach it, or the point tried faces away.
  std::optional<LightSample> sample(const Surface& surface, Vec3 facing_normal, float choice, Vec2 u) const;

  /// The same for the first `count` of `surfaces`, with the same answers. `from` has their positions and
  /// facing normals.
  void sample(const SurfaceBlock& surfaces, int count, const Receivers& from, Floats& choices, const Vec2s& u,
              LightSamples& out) const;

  /// The radiance of the dome along a ray that hits nothing.
  Vec3 dome(Vec3 direction) const { return sky_ ? sky_radiance(*sky_, direction) : Vec3{}; }

  /// A light from far away that a ray may run into, and the density with which sample() finds the direction.
  struct FarLight {
    Vec3 radiance;
    float pdf;
  };
  /// Calls visit(FarLight) for the sun, where `direction` (unit length) points into it, and for each picture
  /// of the surroundings.
  template <class Visit>
  void for_each_far_light(Vec3 direction, const Receiver& from, const Visit& visit) const {
    for (std::size_t i = 0; i < far_lights_.size(); ++i)
      if (const FarLight light = far_light(i, direction, from); max_component(light.radiance) > 0)
        visit(light);
  }

  /// The radiance that `surface` sends against `direction`.
  Vec3 emission(const Surface& surface, Vec3 direction) const;

  /// The density, per solid angle, with which sample() finds the point `surface`, which `hit` is on, from
  /// `from`. 0 when it never does.
  float pdf(const Hit& hit, const Surface& surface, Vec3 direction, const Receiver& from) const;

 private:
  /// A light without a place.
  struct Far {
    enum class Kind { distant, sun, environment } kind;
    std::uint32_t index = 0;  // of the distant light or the environment
    Vec3 direction;           // distant and sun: towards it
    float strength = 0;       // irradiance
  };
  /// A light of the tree.
  struct Near {
    enum class Kind { emitter, point, spot } kind;
    std::uint32_t group = 0;  // emitter
    std::uint32_t index = 0;  // in its group, or in the description
  };

  void add_near(const Near& light, const LightBounds& bounds);
  FarLight far_light(std::size_t index, Vec3 direction, const Receiver& from) const;
  float importance(const Far& light, const Receiver& from) const;
  float sum_of_importances(const Receiver& from) const;
  float sum_with_far(float sum, const Receiver& from) const;
  const Far* choose_far(const Receiver& from, float& left, float& weight) const;
  std::optional<LightSample> sample_far(const Far& light, const Surface& surface, float probability,
                                        Vec2 u) const;
  std::optional<LightSample> sample_near(const Near& light, const Surface& surface, float probability,
                                         Vec2 u) const;

  const Scene& scene_;
  std::optional<Sky> sky_;
  std::optional<Sun> sun_;
  std::vector<Far> far_lights_;
  std::vector<EnvironmentLight> environments_;
  std::vector<Near> near_lights_;
  std::vector<FlatLight> flat_lights_;    // one for each of near_lights_,
  std::vector<char> is_flat_;             // if it is one
  std::vector<LightBounds> near_bounds_;  // only while the tree is built
  LightTree tree_;
  std::vector<EmitterGroup> groups_;
  std::vector<std::uint32_t> group_of_instance_;  // InstanceId -> groups_; kNoGroup
  std::vector<std::uint32_t> first_of_group_;     // in near_lights_
};

}  // namespace boxwood::render
