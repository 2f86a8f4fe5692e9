// load.h: how does a file become a scene? The front door of all formats.
#pragma once

#include <filesystem>

#include "boxwood/core/error.h"
#include "boxwood/core/parallel.h"
#include "boxwood/scene/description.h"

namespace boxwood::io {

/// Whether the name ends like a format that load() reads (.obj .ply .stl .gltf .glb .pbrt, in any case).
bool is_loadable(const std::filesystem::path& path);

/// Reads a scene file and everything that it refers to. What a scene can do without (a texture that is
/// missing, a material that is not known) is named in SceneDesc::warnings. Throws FileError when the file
/// cannot be used; it never crashes, whatever the bytes are.
SceneDesc load(const std::filesystem::path& path, Executor* executor = nullptr);

}  // namespace boxwood::io
