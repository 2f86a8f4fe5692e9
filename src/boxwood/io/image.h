// image.h: how does a picture become a file, and a file a texture? By OpenImageIO.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "boxwood/core/error.h"
#include "boxwood/io/file_bytes.h"
#include "boxwood/scene/description.h"
#include "boxwood/scene/image.h"

namespace boxwood::io {

/// How an .exr is written, and what it holds beside the picture itself.
struct ExrOptions {
  /// Channels of light, colors and normals as half floats; what halves could not hold (distances, places,
  /// numbers) stays float. Light beyond 65504 becomes that.
  bool is_half = false;
  std::string note;  ///< A text of the program's own; none when empty.
  /// Planes of words, kept bit for bit: height x width x word_names.size().
  std::vector<std::string> word_names;
  std::span<const std::uint32_t> words;
};

/// Writes `image` beside `path` and renames it into place, so that `path` is never a partial file. The ending
/// chooses the format: .png (8 bits, encoded as sRGB, clamped to [0, 1]; needs 1, 3 or 4 channels), .exr
/// (float unless asked otherwise), .hdr. `lasting` is as for write_file. Throws FileError when the ending is
/// not one of these or the file cannot be written.
void write_image(const std::filesystem::path& path, const Image& image, const ExrOptions& exr = {},
                 Lasting lasting = Lasting::yes);

/// Reads any picture that OpenImageIO reads, as linear floats. Throws FileError.
Image read_image(const std::filesystem::path& path);

/// An .exr with all that write_image put into it.
struct ExrFile {
  Image image;
  std::string note;  ///< Empty when there is none.
  std::vector<std::string> word_names;
  std::vector<std::uint32_t> words;
};

/// Reads an .exr, whose channels may be of different kinds. Throws FileError.
ExrFile read_exr(const std::filesystem::path& path);

/// Reads a texture from a file, or from the bytes of one (`name` is then for messages). Throws FileError.
Texture read_texture(const std::filesystem::path& path);
Texture read_texture(std::span<const std::byte> bytes, const std::string& name);

}  // namespace boxwood::io
