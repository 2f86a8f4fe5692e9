// light_sample.h: what is known of a try to reach a light?
#pragma once

#include "boxwood/core/block.h"

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

/// The same for a block of points. Where pdf is 0 nothing can be reached.
struct LightSamples {
  Vec3s direction, radiance;
  Floats pdf{};
  Integers is_perfect{};
  RayBlock shadow_rays;

  void set(int i, const LightSample& sample) {
    direction.set(i, sample.direction);
    radiance.set(i, sample.radiance);
    pdf[i] = sample.pdf;
    is_perfect[i] = sample.is_perfect;
    shadow_rays.set(i, sample.shadow_ray);
  }
};

}  // namespace boxwood::render
