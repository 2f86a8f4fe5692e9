// shadow.h: how much of a light gets past what is in the way?
//
// All or nothing, except where surfaces let light go straight on: cut-outs, veils, the boundaries of media.
// Rays that meet the box of such a thing look for the first surface in their way, and are walked on from
// there if it lets light through; all others only ask whether there is anything.
#pragma once

#include <memory>
#include <vector>

#include "boxwood/core/block.h"
#include "boxwood/render/integrator.h"
#include "boxwood/scene/scene.h"

namespace boxwood::render {

/// What a medium leaves of the light after a distance (the law of Beer, Lambert and Bouguer); where it takes
/// nothing, all of it, however far.
inline Vec3 beer(Vec3 absorption, float distance) {
  const auto left = [&](float a) { return a > 0 ? std::exp(-a * distance) : 1.0f; };
  return {left(absorption.x), left(absorption.y), left(absorption.z)};
}

/// Light on its way to samples. It arrives if nothing is in the way.
class AwaitedLight {
 public:
  /// Of so many rays at most.
  explicit AwaitedLight(std::size_t capacity)
      : plain_(capacity),
        careful_(capacity),
        absorption_(capacity),
        is_hidden_(new bool[capacity]),
        hits_(capacity) {}

  void clear() { plain_.size = careful_.size = 0; }
  /// Light that comes to `sample` along `ray`, which meets no veil (Shadows::find_veiled) and is in no
  /// medium.
  void add(std::uint32_t sample, Vec3 light, const Ray& ray) { plain_.add(ray, {sample, light}); }
  /// The same along a ray of which this is not known, through a medium of this absorption at its start.
  void add_careful(std::uint32_t sample, Vec3 light, const Ray& ray, Vec3 absorption) {
    absorption_[careful_.size] = absorption;
    careful_.add(ray, {sample, light});
  }

 private:
  friend class Shadows;
  struct Light {
    std::uint32_t sample;
    Vec3 light;
  };
  struct Row {
    explicit Row(std::size_t capacity) : rays(capacity), lights(capacity) {}
    void add(const Ray& ray, const Light& light) {
      rays[size] = ray;
      lights[size++] = light;
    }
    std::vector<Ray> rays;
    std::vector<Light> lights;
    std::size_t size = 0;
  };
  /// Rays that only ask whether there is anything, and those that look for the first surface.
  Row plain_, careful_;
  std::vector<Vec3> absorption_;  // of the latter
  // Memory for the answers.
  std::unique_ptr<bool[]> is_hidden_;
  std::vector<Hit> hits_;
};

class Shadows {
 public:
  /// Keeps a reference.
  explicit Shadows(const Scene& scene);

  /// Which rays of a block may meet something that lets light through.
  void find_veiled(const RayBlock& rays, Integers& may_meet_veil) const;

  /// Adds to the three floats that each sample has in `samples` what arrives, and to its counts in `rays`
  /// those that were traced.
  void deliver(AwaitedLight& light, std::span<float> samples, std::span<RayCounts> rays) const;

 private:
  Vec3 walk(const Ray& way, const Hit& first_hit, Vec3 absorption, RayCounts& rays) const;

  const Scene& scene_;
  float reach_ = 0;            // the largest coordinate in the scene
  std::vector<Box3> veils_;    // around all that light may go through
  std::vector<char> is_veil_;  // by instance
};

}  // namespace boxwood::render
