#include "boxwood/render/next_rays.h"

namespace boxwood::render {
namespace {

/// The largest chance to go on: even a path that loses nothing comes to an end.
constexpr float kMaxSurvival = 0.95f;

}  // namespace

#define BOXWOOD_LOOPS "boxwood/render/next_rays-inl.h"
#include "boxwood/core/every_cpu-inl.h"

void send_rays(const PathPoints& paths, const SurfaceBlock& surfaces, const Scattered& scattered,
               const LightSamples& lights, NextRays& out) {
  const bool is_wide = has_avx2();
  (is_wide ? avx2::ask_for_light : everywhere::ask_for_light)(paths, scattered, lights, out);
  (is_wide ? avx2::go_on : everywhere::go_on)(paths, surfaces, scattered, out);
}

}  // namespace boxwood::render
