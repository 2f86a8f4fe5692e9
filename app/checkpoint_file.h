// checkpoint_file.h: where does a render leave what it has, so that a kill costs it little?
//
// In a file beside the picture, which is replaced as a whole: whenever the program dies, the file is the last
// whole checkpoint. A render that ends as it should removes it.
#pragma once

#include <filesystem>
#include <string>

#include "boxwood/render/job.h"

namespace boxwood::app {

class CheckpointFile {
 public:
  /// That of the picture `output`. A device or a pipe has none, and nothing is written.
  explicit CheckpointFile(const std::string& output);

  const std::string& path() const { return path_; }
  bool is_possible() const { return !path_.empty(); }
  bool exists() const;

  /// Throws FileError.
  void write(const render::RenderJob& job) const;
  /// Brings the job to where it was. Throws FileError.
  void read(render::RenderJob& job) const;
  /// Removes the file, and what killed programs left of writing it.
  void remove() const;

 private:
  std::string path_;
};

}  // namespace boxwood::app
