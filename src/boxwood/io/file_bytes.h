// file_bytes.h: what is in this file?
//
// Every reader of this room starts here, so that a path that is missing, a folder or not readable is reported
// once and in the same words. Files are read whole: the readers then work on memory that cannot change or end
// under them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace boxwood::io {

/// The bytes of a file. Throws FileError when it does not exist, is not a regular file, is empty, or cannot
/// be read.
std::string read_file(const std::filesystem::path& path);

/// Writes the bytes beside `path` and renames them into place, so that `path` is never a partial file and
/// keeps what it was when something fails. Throws FileError.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// The ending of a file name in lower case with its dot, such as ".obj"; empty where there is none.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace boxwood::io
