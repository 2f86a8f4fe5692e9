// pbrt_files.h: what do the files hold that a pbrt scene names?
//
// PLY meshes and pictures are noted while the scene is read, and read together when it is known which of them
// anything shows: in parallel, each once.
#pragma once

#include <span>
#include <vector>

#include "boxwood/core/parallel.h"
#include "boxwood/io/pbrt_shape.h"
#include "boxwood/io/pbrt_texture.h"

namespace boxwood::io::pbrt {

/// A mesh that some shape needs.
struct MeshFile {
  std::filesystem::path path;
  GeometryId geometry;  ///< Its place in the scene.
  ShapeFrame frame;
  Place place;
};

/// Fills in the geometries and textures of `desc` that wait for a file, and takes out the textures that no
/// material shows. A picture that cannot be read is named in a warning, and a plain grey stands in; a mesh
/// that cannot be read is an error. The message is that of the first in the scene, whoever came first.
void read_files(SceneDesc& desc, std::span<const MeshFile> meshes, std::span<const Picture> pictures,
                Warnings& warnings, Executor& executor);

}  // namespace boxwood::io::pbrt
