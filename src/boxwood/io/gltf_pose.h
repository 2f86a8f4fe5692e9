// gltf_pose.h: which form has a mesh at its node, at rest?
//
// Morph targets move its vertices by what their weights say; a skin takes them to where its joints stand. See
// the glTF 2.0 specification, sections 3.7.2.2 and 3.7.3.
#pragma once

#include <optional>
#include <span>

#include "boxwood/io/gltf_model.h"
#include "boxwood/scene/description.h"

namespace boxwood::io::gltf {

/// The weights of a node's morph targets; empty where none of them counts.
std::vector<float> morph_weights(const File& file, int node);

/// Moves the vertices of a primitive by its targets. Throws FileError for data that does not fit together.
void morph(const File& file, std::size_t mesh, std::size_t primitive, std::span<const float> weights,
           TriangleMesh& vertices);

/// Where each joint of a skin takes vertices: world_from_joint * joint_from_mesh. None where a joint stands
/// nowhere. Throws FileError for data that does not fit together.
std::optional<std::vector<Affine3>> joint_transforms(const File& file, int skin,
                                                     std::span<const std::optional<Affine3>> world_from_node);

/// Takes the vertices of a primitive to the world, each by the mean of its joints. Throws FileError likewise.
void bend(const File& file, std::size_t mesh, std::size_t primitive, std::span<const Affine3> joints,
          TriangleMesh& vertices);

}  // namespace boxwood::io::gltf
