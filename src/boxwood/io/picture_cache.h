// picture_cache.h: how are pictures read that are larger than memory?
//
// A tile at a time, when a renderer asks for it, through the image cache of OpenImageIO, which forgets what
// was not asked for lately and makes the smaller levels that a file does not hold.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "boxwood/scene/description.h"

namespace boxwood::io {

/// How many bytes of all pictures together stay in memory, roughly.
inline constexpr int kPictureCacheMegabytes = 256;

/// A texture whose picture stays in its file, which is looked at to see whether it can be read. Throws
/// FileError when it cannot.
Texture open_texture(const std::filesystem::path& path);

/// The same for the bytes of a picture file, which are copied; `name` is for messages.
Texture open_texture(std::span<const std::byte> bytes, const std::string& name);

}  // namespace boxwood::io
