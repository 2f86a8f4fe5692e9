#include "checkpoint_file.h"

#include <system_error>

#include "boxwood/core/error.h"
#include "boxwood/io/file_bytes.h"
#include "boxwood/render/checkpoint.h"

namespace boxwood::app {

CheckpointFile::CheckpointFile(const std::string& output)
    : path_(io::is_device_or_pipe(output) ? "" : output + ".checkpoint") {}

bool CheckpointFile::exists() const {
  std::error_code ignored;
  return is_possible() && std::filesystem::exists(path_, ignored);
}

void CheckpointFile::write(const render::RenderJob& job) const {
  if (is_possible())
    io::write_file(path_, [&job](const io::ByteSink& sink) { render::write_checkpoint(job, sink); });
}

void CheckpointFile::read(render::RenderJob& job) const {
  const std::string bytes = io::read_file(path_);
  try {
    render::read_checkpoint(job, bytes);
  } catch (const std::runtime_error& error) {
    throw FileError(path_, "", error.what());
  }
}

void CheckpointFile::remove() const {
  if (!is_possible()) return;
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  io::remove_parts(path_);
}

}  // namespace boxwood::app
