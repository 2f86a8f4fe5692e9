// output_file.h: can the result be written at all? Better asked before an hour of work than after it.
#pragma once

#include <filesystem>

namespace boxwood::app {

/// Throws FileError when a file could not be written at `path`: its folder is missing or refuses new files,
/// or `path` is a folder itself. Leaves nothing behind.
void check_writable(const std::filesystem::path& path);

/// From here on, writing more than the shell allows (ulimit -f) fails like writing to a full disk, instead of
/// ending the program.
void survive_size_limits();

}  // namespace boxwood::app
