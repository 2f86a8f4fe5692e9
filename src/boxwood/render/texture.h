// texture.h: which color does a texture have at a point?
#pragma once

#include "boxwood/scene/description.h"

namespace boxwood::render {

/// The color at `uv` in linear light: the texture repeats in both directions, v points up, and the four
/// nearest texels are mixed (after decoding, since sRGB codes are not proportional to light). White when
/// there are no texels.
Vec3 texture_color(const Texture& texture, Vec2 uv);

}  // namespace boxwood::render
