// path.h: how much light comes along a ray? Path tracing.
//
// Many paths go on together, a step at a time: all their rays are traced as one batch, then each path looks
// at what it hit, asks for light and picks its next direction, then all rays towards lights are traced as one
// batch. New paths take the places of those that end. The kernels answer a batch of rays that go all ways
// about twice as fast as the same rays one by one (Laine, Karras and Aila, "Megakernels Considered Harmful",
// HPG 2013, for the idea on other machines). A path keeps its own numbers and a sample its own sum, so what
// they find does not depend on their company.
#pragma once

#include "boxwood/render/integrator.h"
#include "boxwood/render/render.h"
#include "boxwood/scene/scene.h"

namespace boxwood::render {

/// The integrator of Mode::path. `camera` places the plain sky that a scene without any light is shown under;
/// `pixel_angle` is how wide a pixel is, in radians, for the width at which textures are looked up; paths end
/// after so many bounces, if not before. Keeps a reference to `scene`.
std::unique_ptr<Integrator> make_path_tracer(const Scene& scene, const Camera& camera, float pixel_angle = 0,
                                             int bounces = kMaxBounces);

}  // namespace boxwood::render
