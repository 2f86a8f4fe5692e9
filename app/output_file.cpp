#include "output_file.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "boxwood/core/error.h"
#include "boxwood/io/file_bytes.h"

namespace boxwood::app {

void check_writable(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw FileError(path.string(), "", "this is a folder, expected the name of a file to write");
  if (io::is_device_or_pipe(path)) return;  // Takes what it is given; asking would already be writing.

  // A link's file is written where it is.
  std::error_code is_new;
  const std::filesystem::path target = std::filesystem::canonical(path, is_new);
  const std::filesystem::path& file_path = is_new ? path : target;
  const std::filesystem::path folder = file_path.has_parent_path() ? file_path.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, ignored))
    throw FileError(path.string(), "",
                    "cannot be written, because the folder " + folder.string() + " does not exist");

  // Permissions, full disks and read-only mounts have many rules; making a file there asks them all.
  const std::string probe = (folder / (".boxwood-probe-" + std::to_string(getpid()))).string();
  const int file = open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0)
    throw FileError(path.string(), "",
                    "cannot be written: the folder " + folder.string() + " takes no new file (" +
                        std::strerror(errno) + ")");
  close(file);
  unlink(probe.c_str());
}

void survive_size_limits() {
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace boxwood::app
