#include "boxwood/io/file_bytes.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <unistd.h>

#include "boxwood/core/error.h"

namespace boxwood::io {

std::string read_file(const std::filesystem::path& path) {
  // Say plainly what is wrong with the path itself;
  // streams would open a folder and fail later without a reason.
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found)
    throw FileError(path.string(), "", "no such file");
  if (error) throw FileError(path.string(), "", "cannot be read: " + error.message());
  if (status.type() == std::filesystem::file_type::directory)
    throw FileError(path.string(), "", "is a folder, expected a file");
  if (status.type() != std::filesystem::file_type::regular)
    throw FileError(path.string(), "", "is not a regular file");

  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw FileError(path.string(), "", "cannot be read: " + error.message());
  if (size == 0) throw FileError(path.string(), "", "the file is empty");
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw FileError(path.string(), "", std::string("cannot be opened: ") + std::strerror(errno));
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size)
    throw FileError(
        path.string(), "",
        "could be read only up to byte " + std::to_string(stream.gcount()) + " of " + std::to_string(size));
  return bytes;
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

bool is_device_or_pipe(const std::filesystem::path& path) {
  using std::filesystem::file_type;
  std::error_code ignored;
  const file_type type = std::filesystem::status(path, ignored).type();
  return type == file_type::character || type == file_type::block || type == file_type::fifo;
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw FileError(path.string(), "", "is a folder, expected a file");
  if (!std::filesystem::is_directory(folder, error))
    throw FileError(path.string(), "", "cannot be written: there is no folder " + folder.string());

  // A rename would put a plain file in the place of a device or a pipe: /dev/null would be gone.
  const bool is_stream = is_device_or_pipe(path);
  // It would also cut a link off from the file that it names.
  std::filesystem::path target = is_stream ? path : std::filesystem::canonical(path, error);
  if (error) target = path;  // There is no such file yet.

  // A name of our own, even when several threads and programs write the same file at once.
  static std::atomic<unsigned> serial{0};
  std::filesystem::path part = target;
  if (!is_stream) part += ".part" + std::to_string(::getpid()) + "-" + std::to_string(serial++);

  errno = 0;
  std::ofstream stream(part, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  std::string reason;
  if (!stream) {
    reason = errno != 0 ? std::strerror(errno) : "the disk took only a part of it";
  } else if (!is_stream) {
    std::filesystem::rename(part, target, error);
    if (error) reason = error.message();
  }
  if (!reason.empty()) {
    if (!is_stream) std::filesystem::remove(part, error);
    throw FileError(path.string(), "", "cannot be written: " + reason);
  }
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

}  // namespace boxwood::io
