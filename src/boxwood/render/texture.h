// texture.h: which color does a texture have at a point?
#pragma once

#include "boxwood/scene/description.h"

namespace boxwood::render {

/// The color at `uv` in linear light: the texture repeats in both directions, v points up, and the four
/// nearest texels are mixed (after decoding, since sRGB codes are not proportional to light). White when
/// there are no texels.
Vec3 texture_color(const Texture& texture, Vec2 uv);

/// sRGB code in [0, 1] to linear light, and back. IEC 61966-2-1.
float linear_from_srgb(float code);
float srgb_from_linear(float light);

}  // namespace boxwood::render
