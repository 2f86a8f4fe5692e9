// material.h: which material is a surface made of, and which color has it there?
#pragma once

#include "boxwood/scene/description.h"

namespace boxwood::render {

/// The material that `id` names; grey and matte for none.
const Material& material_of(const SceneDesc& desc, MaterialId id);

/// The material's color times its texture at `uv`, kept within [0, 1]: no surface reflects more than it gets.
Vec3 base_color(const SceneDesc& desc, const Material& material, Vec2 uv);

inline bool is_emissive(const Material& material) {
  return max_component(material.emission) > 0;
}

}  // namespace boxwood::render
