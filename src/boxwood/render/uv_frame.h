// uv_frame.h: how do texture coordinates lie on a surface?
#pragma once

#include <optional>

#include "boxwood/scene/surface.h"

namespace boxwood::render {

/// Along which vectors of the world u and v grow by 1, on the triangle that was hit.
struct UvFrame {
  Vec3 along_u, along_v;
};

/// Nothing where the hit is not on a mesh with texture coordinates, or they are all the same there.
std::optional<UvFrame> uv_frame(const Scene& scene, const Hit& hit);

/// The normal that a normal map (a material's normal_texture) gives the surface; its shading normal where
/// there is none.
Vec3 mapped_normal(const Scene& scene, const Hit& hit, const Surface& surface, const Material& material);

}  // namespace boxwood::render
