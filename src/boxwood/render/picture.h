// picture.h: which picture do the sums of a film make?
#pragma once

#include "boxwood/render/camera.h"
#include "boxwood/render/film.h"
#include "boxwood/render/render.h"

namespace boxwood::render {

/// The mode's channels, then those of `layers`, which must be all those that the film was filled with, or
/// none. Each mean divides by what was counted; a pixel without samples is 0. Names of things stay 0: they do
/// not come from samples.
Image picture_of(const Film& film, Mode mode, std::span<const Layer> layers);

/// Fills the layers that are names of things: one ray through the middle of each pixel, by the options'
/// executor.
void write_names(Image& image, const Scene& scene, const Lens& lens, const RenderOptions& options);

}  // namespace boxwood::render
