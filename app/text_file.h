// text_file.h: how does text become a file that is never partial? As pictures do (io/image.h): written beside
// its place, then renamed into it.
#pragma once

#include <filesystem>
#include <string_view>

namespace boxwood::app {

/// Replaces the file at `path`, or leaves it as it was and throws FileError.
void write_text(const std::filesystem::path& path, std::string_view text);

}  // namespace boxwood::app
