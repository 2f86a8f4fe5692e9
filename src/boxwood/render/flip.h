// flip.h: what would an eye notice that flips between two pictures on a screen?
//
// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild, "FLIP: A Difference Evaluator for
// Alternating Images", 2020. Details that are too fine for the eye are filtered away; what is left is
// compared as perceived color, and counts for more where edges and points differ.
#pragma once

#include "boxwood/scene/image.h"

namespace boxwood::render {

/// Pixels in a degree of the eye's view: a screen 0.7 m wide with 3840 pixels, seen from 0.7 m.
inline constexpr double kPixelsPerDegree = 67.0206432766;

/// One channel: 0 where nothing would be noticed, up to 1. Both pictures hold three channels of linear light
/// as the screen shows it; they are clamped to [0, 1]. Throws std::invalid_argument when they differ in shape
/// or have another number of channels.
Image flip_map(const Image& picture, const Image& reference, double pixels_per_degree = kPixelsPerDegree);

/// The mean of a map: the FLIP value.
double mean_of(const Image& map);

}  // namespace boxwood::render
