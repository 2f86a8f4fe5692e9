#include "scene_source.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "boxwood/gallery/gallery.h"
#include "boxwood/io/load.h"
#include "console.h"

namespace boxwood::app {
namespace {

constexpr std::size_t kMaxWarningsShown = 20;  // enough to see what is wrong with the file

/// How a user writes the entry: "stilllife", or "spheres:N" when it has a size.
std::string written(const gallery::Entry& entry) {
  return std::string(entry.name) + (entry.default_size > 0 ? ":N" : "");
}

bool is_made(const std::string& name_or_path) {
  return gallery::is_known(name_or_path.substr(0, name_or_path.find(':')));
}

}  // namespace

void check_scene_exists(const std::string& name_or_path) {
  // A file that may not be seen is left to the reader, which says why.
  std::error_code hidden;
  if (is_made(name_or_path) || std::filesystem::exists(name_or_path, hidden) || hidden) return;
  std::string names;
  for (const gallery::Entry& entry : gallery::entries())
    names += (names.empty() ? "" : ", ") + written(entry);
  throw FileError(
      name_or_path, "",
      "there is no such file, and no scene of that name that the program makes itself (" + names + ")");
}

SceneDesc open_scene(const std::string& name_or_path, Executor& executor) {
  check_scene_exists(name_or_path);
  return is_made(name_or_path) ? gallery::make(name_or_path) : io::load(name_or_path, &executor);
}

BuildOptions build_options(const std::string& preset) {
  if (preset == "fast") return BuildOptions::fast();
  if (preset == "best") return BuildOptions::best();
  return BuildOptions::balanced();
}

void print_warnings(const SceneDesc& desc) {
  const std::size_t shown =
      desc.warnings.size() <= kMaxWarningsShown + 1 ? desc.warnings.size() : kMaxWarningsShown;
  for (std::size_t i = 0; i < shown; ++i) print_error("boxwood: warning: {}\n", desc.warnings[i]);
  if (shown < desc.warnings.size())
    print_error("boxwood: warning: and {} more like these\n", desc.warnings.size() - shown);
}

std::string gallery_help() {
  std::string help = "Scenes that the program makes itself [N when it is not given]:\n";
  for (const gallery::Entry& entry : gallery::entries()) {
    help += fmt::format("  {:<14} {}", written(entry), entry.description);
    if (entry.default_size > 0) help += fmt::format(" [{}]", entry.default_size);
    help += "\n";
  }
  return help;
}

}  // namespace boxwood::app
