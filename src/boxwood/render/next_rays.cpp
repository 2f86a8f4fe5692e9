#include "boxwood/render/next_rays.h"

#include "boxwood/core/every_cpu.h"

namespace boxwood::render {
namespace {

/// The largest chance to go on: even a path that loses nothing comes to an end.
constexpr float kMaxSurvival = 0.95f;

}  // namespace

#define BOXWOOD_LOOPS "boxwood/render/next_rays-inl.h"
#include "boxwood/core/every_cpu-inl.h"

void send_rays(const PathPoints& paths, const SurfaceBlock& surfaces, const Scattered& scattered,
               const LightSamples& lights, NextRays& out) {
  BOXWOOD_BEST(ask_for_light)(paths, scattered, lights, out);
  BOXWOOD_BEST(go_on)(paths, surfaces, scattered, out);
}

}  // namespace boxwood::render
