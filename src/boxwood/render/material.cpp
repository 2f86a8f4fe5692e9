#include "boxwood/render/material.h"

#include "boxwood/render/texture.h"

namespace boxwood::render {

const Material& material_of(const SceneDesc& desc, MaterialId id) {
  static const Material kDefault;
  return id.is_valid() ? desc.materials[id.value] : kDefault;
}

Vec3 base_color(const SceneDesc& desc, const Material& material, Vec2 uv) {
  Vec3 color = material.color;
  if (material.color_texture.is_valid())
    color *= texture_color(desc.textures[material.color_texture.value], uv);
  return min(max(color, {0, 0, 0}), {1, 1, 1});
}

}  // namespace boxwood::render
