// mtl.h: which materials does this MTL file define?
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "boxwood/scene/description.h"

namespace boxwood::io {

/// Adds the file's materials and their textures to `desc` and their names to `ids`; a name that comes again
/// wins. What cannot be read, the file itself included, becomes a line of desc.warnings.
void load_mtl(const std::filesystem::path& path, SceneDesc& desc, std::map<std::string, MaterialId>& ids);

}  // namespace boxwood::io
