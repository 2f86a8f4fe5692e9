// shadow.h: how much of a light gets past what is in the way?
//
// All or nothing, except where surfaces let light go straight on: cut-outs, veils, the boundaries of media.
// Rays that meet the box of such a thing look for the first surface in their way, and are walked on from
// there if it lets light through; all others only ask whether there is anything.
#pragma once

#include <vector>

#include "boxwood/render/integrator.h"
#include "boxwood/scene/scene.h"

namespace boxwood::render {

/// What a medium leaves of the light after a distance (the law of Beer, Lambert and Bouguer); where it takes
/// nothing, all of it, however far.
inline Vec3 beer(Vec3 absorption, float distance) {
  const auto left = [&](float a) { return a > 0 ? std::exp(-a * distance) : 1.0f; };
  return {left(absorption.x), left(absorption.y), left(absorption.z)};
}

class Shadows {
 public:
  /// Keeps a reference.
  explicit Shadows(const Scene& scene);

  /// A question: how much light gets from one end of `ray` to the other, through a medium of this absorption
  /// at its start?
  struct Way {
    Ray ray;
    Vec3 absorption;
  };
  /// Answers many. Adds the rays it traced to `rays`.
  void transmittances(std::span<const Way> ways, std::span<Vec3> out, RayCounts& rays) const;

 private:
  void find_veiled(std::span<const Way> ways, std::span<char> is_veiled) const;
  Vec3 walk(const Way& way, const Hit& first_hit, RayCounts& rays) const;

  const Scene& scene_;
  float reach_ = 0;            // the largest coordinate in the scene
  std::vector<Box3> veils_;    // around all that light may go through
  std::vector<char> is_veil_;  // by instance
};

}  // namespace boxwood::render
