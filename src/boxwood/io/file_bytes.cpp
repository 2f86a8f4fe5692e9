#include "boxwood/io/file_bytes.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "boxwood/core/error.h"

namespace boxwood::io {
namespace {

// Between the name of a file that is being written and a number; the whole file gets the name itself.
constexpr const char* kPartEnding = ".part";

/// Has the system bring the file, or the entries of the folder, to the disk. 0, or what went wrong. File
/// systems that cannot do so for folders say EINVAL.
int bring_to_disk(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int problem = ::fsync(descriptor) == 0 || errno == EINVAL ? 0 : errno;
  ::close(descriptor);
  return problem;
}

}  // namespace

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

void write_file(const std::filesystem::path& path, std::string_view bytes, Lasting lasting) {
  write_file(
      path, [bytes](const ByteSink& sink) { sink(bytes); }, lasting);
}

void write_file(const std::filesystem::path& path, const std::function<void(const ByteSink&)>& produce,
                Lasting lasting) {
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
  if (!is_stream) part += kPartEnding + std::to_string(::getpid()) + "-" + std::to_string(serial++);
  const auto give_up = [&] {
    if (!is_stream) std::filesystem::remove(part, error);
  };

  errno = 0;
  std::ofstream stream(part, std::ios::binary);
  int first_errno = stream ? 0 : errno;
  try {
    produce([&](std::string_view bytes) {
      if (!stream) return;  // Say why the first write failed, not the last.
      errno = 0;
      stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      if (!stream) first_errno = errno;
    });
  } catch (...) {
    stream.close();
    give_up();
    throw;
  }
  errno = 0;
  stream.close();
  std::string reason;
  if (!stream) {
    if (first_errno == 0) first_errno = errno;
    reason = first_errno != 0 ? std::strerror(first_errno) : "the disk took only a part of it";
  } else if (!is_stream) {
    // Contents before the name: after a loss of power the name must not stand for a file without them.
    const bool is_lasting = lasting == Lasting::yes;
    if (const int problem = is_lasting ? bring_to_disk(part) : 0; problem != 0)
      reason = std::strerror(problem);
    if (reason.empty()) std::filesystem::rename(part, target, error);
    if (error) reason = error.message();
    // The new file is whole under either name; when the folder gets there is the system's affair.
    if (reason.empty() && is_lasting) (void)bring_to_disk(folder);
  }
  if (!reason.empty()) {
    give_up();
    throw FileError(path.string(), "", "cannot be written: " + reason);
  }
}

void remove_parts(const std::filesystem::path& path) {
  // The number of a process and a serial number, and nothing else: other names may be anybody's.
  const auto is_part = [start = path.filename().string() + kPartEnding](const std::string& name) {
    if (!name.starts_with(start)) return false;
    const std::size_t dash = name.find('-', start.size());
    return dash != std::string::npos && dash > start.size() && dash + 1 < name.size() &&
           name.find_first_not_of("0123456789", start.size()) == dash &&
           name.find_first_not_of("0123456789", dash + 1) == std::string::npos;
  };
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  std::vector<std::filesystem::path> parts;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (is_part(entry->path().filename().string())) parts.push_back(entry->path());
  for (const std::filesystem::path& part : parts) std::filesystem::remove(part, error);
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

}  // namespace boxwood::io
