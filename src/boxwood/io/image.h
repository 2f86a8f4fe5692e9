// image.h: how does a picture become a file, and a file a texture? By OpenImageIO.
#pragma once

#include <filesystem>
#include <span>

#include "boxwood/core/error.h"
#include "boxwood/scene/description.h"
#include "boxwood/scene/image.h"

namespace boxwood::io {

/// Writes `image` beside `path` and renames it into place, so that `path` is never a partial file. The ending
/// chooses the format: .png (8 bits, encoded as sRGB, clamped to [0, 1]; needs 1, 3 or 4 channels), .exr
/// (float), .hdr. Throws FileError when the ending is not one of these or the file cannot be written.
void write_image(const std::filesystem::path& path, const Image& image);

/// Reads any picture that OpenImageIO reads, as linear floats. Throws FileError.
Image read_image(const std::filesystem::path& path);

/// Reads a texture from a file, or from the bytes of one (`name` is then for messages). Throws FileError.
Texture read_texture(const std::filesystem::path& path);
Texture read_texture(std::span<const std::byte> bytes, const std::string& name);

}  // namespace boxwood::io
