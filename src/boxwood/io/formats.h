// formats.h: which readers stand behind the front door? Internal to this room; users call load() of load.h.
//
// A reader turns one file, and what it refers to, into plain data. It throws FileError with the path and the
// place for what it cannot read, and adds a line to SceneDesc::warnings for what the scene can do without. It
// need not check that coordinates are finite and that indices are in range: load() does that for all formats
// alike.
#pragma once

#include <filesystem>

#include "boxwood/core/error.h"
#include "boxwood/core/parallel.h"
#include "boxwood/scene/description.h"

namespace boxwood::io {

SceneDesc load_obj(const std::filesystem::path& path, Executor& executor);
SceneDesc load_ply(const std::filesystem::path& path, Executor& executor);
SceneDesc load_stl(const std::filesystem::path& path, Executor& executor);
SceneDesc load_gltf(const std::filesystem::path& path, Executor& executor);  ///< .gltf and .glb
SceneDesc load_pbrt(const std::filesystem::path& path, Executor& executor);

/// The one mesh of a PLY file, which pbrt scenes refer to.
/// Throws FileError; a file with no triangles is an error.
TriangleMesh read_ply_mesh(const std::filesystem::path& path);

}  // namespace boxwood::io
