// file_bytes.h: what is in this file?
//
// Every reader of this room starts here, so that a path that is missing, a folder or not readable is reported
// once and in the same words. Files are read whole: the readers then work on memory that cannot change or end
// under them.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace boxwood::io {

/// The bytes of a file. Throws FileError when it does not exist,
/// is not a regular file, is empty, or cannot be read.
std::string read_file(const std::filesystem::path& path);

/// The text without the UTF-8 byte order mark that some editors put before it.
std::string_view without_byte_order_mark(std::string_view text);

/// Whether `path` names something that takes bytes and keeps no file, such as /dev/null or a named pipe.
bool is_device_or_pipe(const std::filesystem::path& path);

/// Whether a file must be whole even after a loss of power. To wait for the disk takes a moment, which files
/// that are soon replaced do not need.
enum class Lasting { no, yes };

/// Writes the bytes beside `path`, waits until they are on the disk if they must last, and renames them into
/// place, so that `path` is never a partial file and keeps what it was when something fails. A link stays and
/// the file behind it is replaced; devices and pipes are written to. Throws FileError.
void write_file(const std::filesystem::path& path, std::string_view bytes, Lasting lasting = Lasting::yes);

/// The same for bytes that come in pieces: `produce` hands them to `sink`, one after another. When `produce`
/// throws, nothing is left behind.
using ByteSink = std::function<void(std::string_view)>;
void write_file(const std::filesystem::path& path, const std::function<void(const ByteSink& sink)>& produce,
                Lasting lasting = Lasting::yes);

/// Removes the parts that programs left beside `path` that were killed while they wrote it.
void remove_parts(const std::filesystem::path& path);

/// The ending of a file name in lower case with its dot, such as ".obj"; empty where there is none.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace boxwood::io
