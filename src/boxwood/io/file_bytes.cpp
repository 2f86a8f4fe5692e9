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
  // Say plainly what is wrong with the path itself; streams would open a folder and fail later without a
  // reason.
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

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw FileError(path.string(), "", "is a folder, expected a file");
  if (!std::filesystem::is_directory(folder, error))
    throw FileError(path.string(), "", "cannot be written: there is no folder " + folder.string());

  // A name of our own, even when several threads and programs write the same file at once.
  static std::atomic<unsigned> serial{0};
  std::filesystem::path part = path;
  part += ".part" + std::to_string(::getpid()) + "-" + std::to_string(serial++);

  errno = 0;
  std::ofstream stream(part, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  std::string reason;
  if (!stream) {
    reason = errno != 0 ? std::strerror(errno) : "the disk took only a part of it";
  } else {
    std::filesystem::rename(part, path, error);
    if (error) reason = error.message();
  }
  if (!reason.empty()) {
    std::filesystem::remove(part, error);
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
