// render_arguments.h: what may a user ask of `boxwood render`?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "boxwood/render/render.h"
#include "picture_file.h"

namespace boxwood::app {

struct RenderArguments {
  std::string scene = "stilllife";
  std::vector<std::string> outputs{"picture.png"};
  std::string size;
  int samples = 0;  // 0: not given
  double noise = 0, seconds = 0;
  std::string bounces, mode = "path", filter = "tent";
  std::vector<std::string> layers;
  PictureLook look;
  std::string preview;
  double checkpoint_seconds = 30;
  bool is_resumed = false;
  std::string shard;
  int threads = 0;
  std::string build = "balanced";
  bool is_quiet = false;
};

/// What --bounces says for as many as the scene's file asks for.
inline constexpr char kAsTheFile[] = "file";

struct Size {
  int width, height;
};

/// Reads "1280x720"; see two_numbers.
std::optional<Size> parse_size(const std::string& text);

/// Adds the options to `command`; what they say goes to `arguments`, which must live as long.
void add_options(CLI::App& command, RenderArguments& arguments);

/// The arguments in the library's terms. Throws std::invalid_argument for values that do not go together or
/// are out of range.
render::RenderOptions options_from(const RenderArguments& arguments);

/// Throws CLI::ValidationError when arguments do not go together, whatever the scene.
void check_together(const RenderArguments& arguments);

}  // namespace boxwood::app
