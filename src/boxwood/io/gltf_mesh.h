// gltf_mesh.h: which triangles does a mesh primitive hold?
#pragma once

#include <optional>

#include "boxwood/io/gltf_model.h"
#include "boxwood/scene/description.h"

namespace boxwood::io::gltf {

/// The primitive as a geometry with its material; none, with a warning, when it holds no triangles (points,
/// lines, no positions). Throws FileError for data that does not fit together. Precondition: both indices
/// exist.
std::optional<Geometry> read_primitive(const File& file, std::size_t mesh, std::size_t primitive,
                                       std::vector<std::string>& warnings);

}  // namespace boxwood::io::gltf
