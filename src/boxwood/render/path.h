// path.h: how much light comes along a ray? Path tracing.
#pragma once

#include "boxwood/render/integrator.h"
#include "boxwood/scene/scene.h"

namespace boxwood::render {

/// The integrator of Mode::path. `camera` places the plain sky that a scene without any light is shown under.
/// Keeps a reference to `scene`.
std::unique_ptr<Integrator> make_path_tracer(const Scene& scene, const Camera& camera);

}  // namespace boxwood::render
