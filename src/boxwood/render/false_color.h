// false_color.h: how does a number become a color that an eye can rank?
#pragma once

#include "boxwood/core/vec.h"
#include "boxwood/scene/image.h"

namespace boxwood::render {

/// From black (0) over red to yellow (1), linear light; equal steps look equal.
Vec3 false_color(float share);

/// The picture of a cost map (channels: boxes tested, shapes tested): their sum in colors from black over red
/// to yellow, with a legend in the lower left corner where the picture has room for one. The scale ends at a
/// round number that all but one in a hundred of the pixels stay below.
Image cost_as_color(const Image& cost);

}  // namespace boxwood::render
