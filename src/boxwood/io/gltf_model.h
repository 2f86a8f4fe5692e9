// gltf_model.h: which model do the bytes of a glTF or GLB file hold?
//
// tinygltf reads the JSON. What it takes on trust is checked before (the container's lengths, the depth of
// the JSON, where files may be read) or afterwards by whoever follows an index (gltf_accessor.h, gltf.cpp).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "boxwood/core/error.h"

namespace tinygltf {
class Model;
}

namespace boxwood::io::gltf {

/// A model and what messages need to speak of it. Pictures stay as the files hold them, not decoded.
struct File {
  std::filesystem::path path;
  std::shared_ptr<const tinygltf::Model> model;

  /// Throws FileError about this file; `place` is an element such as "mesh 3".
  [[noreturn]] void fail(const std::string& place, const std::string& message) const;
};

/// Reads a file of either kind; which one, its first bytes say. Adds a warning for each extension that is not
/// supported. Throws FileError when it cannot be read, is no glTF of version 2, or requires an extension that
/// is not supported.
File read_model(const std::filesystem::path& path, std::vector<std::string>& warnings);

/// Adds a warning, once.
void warn(std::vector<std::string>& warnings, const File& file, const std::string& place,
          const std::string& message);

}  // namespace boxwood::io::gltf
