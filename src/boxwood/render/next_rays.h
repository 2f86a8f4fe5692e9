// next_rays.h: which rays does each path of a block send out next?
//
// One towards the light that it tries, and one onwards, unless chance ends it. Arithmetic and selects only,
// so a block (core/block.h) is worked on by vectors.
#pragma once

#include "boxwood/render/light_sample.h"
#include "boxwood/render/plain_block.h"
#include "boxwood/scene/surface_block.h"

namespace boxwood::render {

/// The weight of a sample of density `a` when the same light could have been found with density `b`: Veach's
/// power heuristic.
inline float power_heuristic(float a, float b) {
  const float ratio = b / a;
  return 1 / (1 + ratio * ratio);
}

/// What is known of the paths themselves.
struct PathPoints {
  Vec3s throughput;
  Integers is_spread{};    ///< Whether it scatters light to other than single directions.
  Integers in_roulette{};  ///< Whether it may be ended by chance, which is uniform in [0, 1):
  Floats chance{};
};

struct NextRays {
  Integers asks_for_light{};
  Vec3s light;  ///< What comes from there if nothing is in the way.
  Integers goes_on{};
  Vec3s throughput, origin;  ///< Of the paths that go on.
};

/// `scattered` says what the surfaces do to light, `lights` where it comes from.
void send_rays(const PathPoints& paths, const SurfaceBlock& surfaces, const Scattered& scattered,
               const LightSamples& lights, NextRays& out);

}  // namespace boxwood::render
