// picture_check.h: can this be a whole picture file?
//
// The codecs below OpenImageIO trust a header before they look at the rest: they make room for billions of
// pixels that a hundred bytes only claim, and libpng prints its complaints. These checks come before them and
// need no codec.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace boxwood::io {

/// The format that OpenImageIO shall try, such as "png": by the first bytes, since a name may be missing or
/// lie, else by the name's ending. Empty when neither says.
std::string picture_format(std::string_view bytes, const std::string& name);

/// The bytes of a picture file that its codec shall see, after the checks below. Throws FileError.
std::string checked_picture(std::string_view bytes, const std::string& name);

/// Throws FileError when a file of so many bytes cannot hold so many numbers.
void check_picture_size(const std::string& name, std::int64_t width, std::int64_t height,
                        std::int64_t channels, std::size_t file_bytes);

/// Walks the headers of an OpenEXR file. Throws FileError with the byte where one is damaged.
void check_exr(std::string_view bytes, const std::string& name);

/// The chunks of a PNG that make its pixels, without texts, color profiles and whatever else may be in it.
/// Throws FileError with the byte where one of them is damaged.
std::string png_essentials(std::string_view bytes, const std::string& name);

}  // namespace boxwood::io
