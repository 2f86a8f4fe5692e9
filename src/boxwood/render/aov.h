// aov.h: what can a ray tell without any light?
// Color, normal, depth, occlusion, cost ("arbitrary output variables").
#pragma once

#include "boxwood/render/integrator.h"
#include "boxwood/render/render.h"

namespace boxwood::render {

/// The integrator of any mode but Mode::path. Keeps a reference to `scene`.
std::unique_ptr<Integrator> make_aov(const Scene& scene, Mode mode);

/// Greys from 1 (nearest) down to 0.12 (farthest) with black for 0,
/// which stands for no hit. `depth` has one channel.
Image depth_as_grey(const Image& depth);

/// Greys in which half open looks half as light.
Image occlusion_as_grey(const Image& occlusion);

/// Each component from [-1, 1] to the sRGB code in [0, 1] that it is usually shown as;
/// decoded, as Image is linear.
Image normal_as_color(const Image& normal);

}  // namespace boxwood::render
