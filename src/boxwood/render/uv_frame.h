// uv_frame.h: how do texture coordinates lie on a surface?
#pragma once

#include <optional>

#include "boxwood/scene/surface.h"

namespace boxwood::render {

/// Along which vectors of the world u and v grow by 1, on the triangle that was hit.
struct UvFrame {
  Vec3 along_u, along_v;
};

/// Of the coordinates in which `texture` lies. Nothing where the hit is not on a mesh with texture
/// coordinates, or they are all the same there.
std::optional<UvFrame> uv_frame(const Scene& scene, const Hit& hit, const Texture& texture);

/// The normal that a normal map gives the surface, its slopes times `scale`; the shading normal where there
/// is no map.
Vec3 mapped_normal(const Scene& scene, const Hit& hit, const Surface& surface, TextureId map, float scale);

/// `normal` as bumps bend it that are `height` times the texture high, in units of the world.
Vec3 bumped_normal(const Scene& scene, const Hit& hit, const Surface& surface, Vec3 normal, float height,
                   const NumberTexture& texture);

}  // namespace boxwood::render
