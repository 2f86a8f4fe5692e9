// gltf_material.h: which of our materials is nearest to one of glTF's?
//
// glTF knows one surface, by base color, metalness and roughness (specification, section 3.9 and appendix B).
// Ours is a metal where it is mostly metal, else a plastic where it is smooth enough to shine, else matte.
#pragma once

#include "boxwood/core/parallel.h"
#include "boxwood/io/gltf_model.h"
#include "boxwood/scene/description.h"

namespace boxwood::io::gltf {

/// Adds all materials of the file, in order, and the pictures of their base colors; warns of what is lost. A
/// picture that is missing or broken is a warning too.
void add_materials(const File& file, Executor& executor, SceneDesc& desc);

/// Which set of texture coordinates a material's base color needs.
int base_color_uv_set(const File& file, int material);

}  // namespace boxwood::io::gltf
