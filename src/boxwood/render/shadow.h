// shadow.h: how much of a light gets past what is in the way?
//
// All or nothing, except where surfaces let light go straight on: cut-outs, veils, the boundaries of media.
// Only in scenes with such surfaces, and only for rays that something blocks, the way is walked from surface
// to surface.
#pragma once

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

  /// The share that gets from one end of `ray` to the other, through a medium of this absorption at its
  /// start. `is_hidden` says whether anything is in the way. Adds the rays it traced to `rays`.
  Vec3 transmittance(const Ray& ray, bool is_hidden, Vec3 absorption, std::uint64_t& rays) const;

 private:
  const Scene& scene_;
  bool has_see_through_ = false;
};

}  // namespace boxwood::render
