// texture.h: which color does a texture have at a point?
//
// Pictures are kept in levels, each half as wide as the one before (Williams, "Pyramidal Parametrics",
// SIGGRAPH 1983), and mixed between the two levels whose pixels are about as wide as what is looked at.
#pragma once

#include "boxwood/scene/surface.h"

namespace boxwood::render {

/// A point of a surface as textures see it: in both sets of texture coordinates, how wide a square of each is
/// looked at (0: a point), and the color of the mesh there.
struct TexturePoint {
  TexturePoint(Vec2 uv, Vec2 second_uv, float width = 0, float second_width = 0)
      : uv(uv), second_uv(second_uv), width(width), second_width(second_width) {}
  explicit TexturePoint(const Surface& surface) : TexturePoint(surface.uv, surface.second_uv) {}
  TexturePoint(const Scene& scene, const Hit& hit, const Surface& surface) : TexturePoint(surface) {
    color = vertex_color(scene, hit);
  }

  Vec2 uv, second_uv;
  float width, second_width;
  std::array<float, 4> color{1, 1, 1, 1};
};

struct Texel {
  Vec3 color;
  float alpha = 1;
};

/// The texture at a point, in linear light, mean over the square that is looked at. v points up. Pictures are
/// mixed between texels after decoding, since sRGB codes are not proportional to light. White when there are
/// no texels.
Texel texture_at(const SceneDesc& desc, TextureId id, const TexturePoint& point);

/// A number there, at the point itself however wide a square is looked at. 1 where there is no texture.
float number_at(const SceneDesc& desc, const NumberTexture& number, const TexturePoint& point);

}  // namespace boxwood::render
