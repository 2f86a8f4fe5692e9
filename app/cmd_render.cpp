// cmd_render.cpp: boxwood render, a picture of a scene.
#include <charconv>
#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "boxwood/io/file_bytes.h"
#include "boxwood/io/image.h"
#include "boxwood/render/render.h"
#include "boxwood/scene/scene.h"
#include "commands.h"
#include "console.h"
#include "interrupt.h"
#include "output_file.h"
#include "progress_bar.h"
#include "scene_source.h"

namespace boxwood::app {
namespace {

constexpr int kDefaultWidth = 1280, kDefaultHeight = 720;

struct RenderArguments {
  std::string scene = "stilllife";
  std::string output = "picture.png";
  std::string size;
  int samples = 64;
  std::string mode = "path";
  int threads = 0;
  std::string build = "balanced";
  bool is_quiet = false;
};

struct Size {
  int width, height;
};

/// Reads "1280x720". Nothing unless the text is two whole numbers around an x; numbers beyond an int become
/// the largest int, which no picture allows.
std::optional<Size> parse_size(const std::string& text) {
  const auto read_number = [](const char*& at, const char* end) -> std::optional<int> {
    int value = 0;
    if (at == end || *at < '0' || *at > '9') return std::nullopt;
    const auto result = std::from_chars(at, end, value);
    at = result.ptr;
    return result.ec == std::errc::result_out_of_range ? std::numeric_limits<int>::max() : value;
  };
  const char *at = text.data(), *end = text.data() + text.size();
  const auto width = read_number(at, end);
  if (!width || at == end || *at++ != 'x') return std::nullopt;
  const auto height = read_number(at, end);
  if (!height || at != end) return std::nullopt;
  return Size{*width, *height};
}

/// What the file can hold: EXR keeps the numbers as they are, the others show them.
Image picture_for(const std::string& ending, const Image& image, render::Mode mode) {
  if (ending == ".exr") return image;
  Image picture = render::displayable(image, mode);
  if (ending == ".png" || picture.channels == 3) return picture;
  // Radiance .hdr files have three channels.
  Image grey(picture.width, picture.height, 3);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) grey.pixels[3 * i + c] = picture.pixels[i];
  return grey;
}

void render_command(const RenderArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  render::RenderOptions options;
  options.mode = render::mode_from_name(arguments.mode);
  options.samples = arguments.samples;
  const std::optional<Size> size = parse_size(arguments.size);
  if (size) {
    options.width = size->width;
    options.height = size->height;
  }

  // Find out what cannot work before any work is done.
  render::check(options);
  check_writable(arguments.output);

  catch_interrupts();
  const std::unique_ptr<Executor> executor = make_executor(arguments.threads);
  ProgressBar bar(arguments.is_quiet);
  bar.update("reading", 0);
  SceneDesc desc = open_scene(arguments.scene, *executor);
  bar.clear();
  print_warnings(desc);
  if (is_interrupted()) throw Cancelled();

  // The size: as asked for here, else in the file, else ours.
  if (!size) {
    const bool has_wish = desc.camera && desc.camera->width > 0 && desc.camera->height > 0;
    options.width = has_wish ? desc.camera->width : kDefaultWidth;
    options.height = has_wish ? desc.camera->height : kDefaultHeight;
    render::check(options);
  }

  BuildOptions build = build_options(arguments.build);
  build.executor = executor.get();
  build.progress = [&bar](std::string_view, double done) {
    bar.update("building", done);
    return !is_interrupted();
  };
  const Scene scene(std::move(desc), build);
  if (is_interrupted()) throw Cancelled();

  const auto render_start = std::chrono::steady_clock::now();
  const auto seconds_since = [](std::chrono::steady_clock::time_point then) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
  };
  const auto mrays_per_s = [&](std::uint64_t rays) {
    return static_cast<double>(rays) * 1e-6 / std::max(seconds_since(render_start), 1e-9);
  };
  options.executor = executor.get();
  options.progress = [&](const render::RenderStatus& status) {
    bar.update("rendering", status.done, fmt::format("{:.2f} Mrays/s", mrays_per_s(status.rays)));
    return !is_interrupted();
  };
  const render::RenderResult result = render_picture(scene, options);
  const double rate = mrays_per_s(result.rays);
  bar.clear();

  io::write_image(arguments.output,
                  picture_for(io::lower_extension(arguments.output), result.image, options.mode));
  if (result.dropped_samples > 0)
    print_error("boxwood: warning: {} samples were not finite and were left out\n", result.dropped_samples);
  if (!result.is_complete)
    throw std::runtime_error("stopped; " + arguments.output + " shows what there was so far");
  if (!arguments.is_quiet)
    print_error("wrote {}: {}x{}, {}, {} samples; {} rays at {:.2f} Mrays/s; {:.1f} s in all\n",
                arguments.output, options.width, options.height, arguments.mode, options.samples, result.rays,
                rate, seconds_since(start));
}

}  // namespace

void add_render(CLI::App& program) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = program.add_subcommand("render", "Make a picture of a scene");
  command
      ->add_option("SCENE", arguments->scene,
                   "A file (.obj .ply .stl .gltf .glb .pbrt) or a\n"
                   "scene that the program makes itself, see below")
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "The picture: .png; .exr or .hdr keep all light")
      ->capture_default_str()
      ->check([](const std::string& path) {
        const std::string ending = io::lower_extension(path);
        const bool is_known = ending == ".png" || ending == ".exr" || ending == ".hdr";
        return is_known ? std::string() : path + " does not end in .png, .exr or .hdr";
      });
  command
      ->add_option("--size", arguments->size,
                   "WIDTHxHEIGHT in pixels; without it the file's own,\nelse 1280x720")
      ->check([](const std::string& text) {
        return parse_size(text) ? std::string() : "'" + text + "' is not a size like 1280x720";
      });
  command->add_option("--samples", arguments->samples, "Rays through each pixel; powers of two look best")
      ->capture_default_str()
      ->check(CLI::Range(1, render::kMaxSamples).description(""));
  command->add_option("--mode", arguments->mode, "path (light), color, normal, depth, occlusion,\ncost")
      ->capture_default_str()
      ->check(CLI::IsMember({"path", "color", "normal", "depth", "occlusion", "cost"}).description(""));
  command
      ->add_option("--threads", arguments->threads,
                   "How many threads work; 0 means all. The picture is\nthe same")
      ->capture_default_str()
      ->check(CLI::Range(0, 4096).description(""));
  command->add_option("--build", arguments->build, "Care that the tree gets: fast, balanced, best")
      ->capture_default_str()
      ->check(CLI::IsMember({"fast", "balanced", "best"}).description(""));
  command->add_flag("--quiet", arguments->is_quiet, "No progress; only warnings and errors");
  command->footer(gallery_help() +
                  "\nExamples:\n"
                  "  boxwood render -o picture.png\n"
                  "  boxwood render bunny.obj -o bunny.png --size 800x800 --samples 256\n"
                  "  boxwood render kitchen/scene.pbrt -o cost.png --mode cost --samples 4\n"
                  "  boxwood render city:1000 -o depth.exr --mode depth --samples 1\n"
                  "\nCtrl-C writes the picture as far as it got (exit code 1); a second Ctrl-C ends\n"
                  "the program at once.");
  command->callback([arguments] { render_command(*arguments); });
}

}  // namespace boxwood::app
