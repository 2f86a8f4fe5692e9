// gltf_material.h: what are glTF's materials made of?
//
// glTF knows one surface, in layers: base color, metalness and roughness (specification, section 3.9 and
// appendix B), and extensions for emission, glass, coats, cloth and the strength of reflections. Ours of the
// kind `layered` follows it part by part. Ambient occlusion is left out: paths find out themselves what is
// shut in.
#pragma once

#include <optional>

#include "boxwood/core/parallel.h"
#include "boxwood/io/gltf_model.h"
#include "boxwood/scene/description.h"

namespace boxwood::io::gltf {

/// Adds all materials of the file, in order, and their pictures; warns of what is lost. A picture that is
/// missing or broken is a warning too. After them comes the format's own material for primitives without one,
/// if there are any.
void add_materials(const File& file, Executor& executor, SceneDesc& desc);

/// Which sets of texture coordinates a material's textures lie in: the base color's, or else that of its
/// first texture, and the first other one.
struct UvSets {
  int first = 0;
  std::optional<int> second;
};
UvSets uv_sets(const File& file, int material);

}  // namespace boxwood::io::gltf
