// texture.h: which color does a texture have at a point?
//
// Pictures are kept in levels, each half as wide as the one before (Williams, "Pyramidal Parametrics",
// SIGGRAPH 1983), and mixed between the two levels whose pixels are about as wide as what is looked at.
#pragma once

#include "boxwood/scene/description.h"

namespace boxwood::render {

struct Texel {
  Vec3 color;
  float alpha = 1;
};

/// The texture at `uv`, in linear light, mean over a square of uv that is `width` wide. v points up. Pictures
/// are mixed between texels after decoding, since sRGB codes are not proportional to light. White when there
/// are no texels.
Texel texture_at(const SceneDesc& desc, TextureId id, Vec2 uv, float width = 0);

}  // namespace boxwood::render
