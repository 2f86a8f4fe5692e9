#include "boxwood/io/load.h"

#include <array>
#include <stdexcept>
#include <string>

#include "boxwood/io/file_bytes.h"
#include "boxwood/io/formats.h"

namespace boxwood::io {
namespace {

struct Format {
  const char* extension;
  SceneDesc (*read)(const std::filesystem::path&, Executor&);
};

// Every format that load() reads, by the ending of the file's name.
constexpr std::array<Format, 0> kFormats = {{}};

const Format* find_format(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  for (const Format& format : kFormats)
    if (extension == format.extension) return &format;
  return nullptr;
}

std::string known_extensions() {
  std::string list;
  for (const Format& format : kFormats) list += (list.empty() ? "" : " ") + std::string(format.extension);
  return list;
}

}  // namespace

bool is_loadable(const std::filesystem::path& path) {
  return find_format(path) != nullptr;
}

SceneDesc load(const std::filesystem::path& path, Executor* executor) {
  const Format* format = find_format(path);
  if (format == nullptr)
    throw FileError(path.string(), "",
                    "the name has none of the endings that can be read: " + known_extensions());
  SceneDesc desc = format->read(path, executor != nullptr ? *executor : serial_executor());
  if (desc.name.empty()) desc.name = path.stem().string();

  // Hold the file to what every scene is held to, here where the message can still name the file.
  if (defined_primitive_count(desc) == 0)
    throw FileError(path.string(), "", "there is no triangle or other shape in it");
  try {
    check(desc);
  } catch (const std::invalid_argument& error) {
    throw FileError(path.string(), "", error.what());
  }
  return desc;
}

}  // namespace boxwood::io
