#include "render_arguments.h"

#include <charconv>
#include <filesystem>
#include <limits>

#include "boxwood/io/file_bytes.h"
#include "scene_source.h"

namespace boxwood::app {
namespace {

// Limits for renders that end for another reason; a shadow that never gets quiet enough must end some time.
constexpr int kDefaultSamples = 64, kNoiseLimit = 1 << 14;

/// Two whole numbers around a mark. Nothing unless the text is just that; numbers beyond an int become the
/// largest int, which nothing allows.
std::optional<std::pair<int, int>> two_numbers(const std::string& text, char mark) {
  const auto read_number = [](const char*& at, const char* end) -> std::optional<int> {
    int value = 0;
    if (at == end || *at < '0' || *at > '9') return std::nullopt;
    const auto result = std::from_chars(at, end, value);
    at = result.ptr;
    return result.ec == std::errc::result_out_of_range ? std::numeric_limits<int>::max() : value;
  };
  const char *at = text.data(), *end = text.data() + text.size();
  const auto first = read_number(at, end);
  if (!first || at == end || *at++ != mark) return std::nullopt;
  const auto second = read_number(at, end);
  if (!second || at != end) return std::nullopt;
  return std::pair(*first, *second);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::optional<int> parse_bounces(const std::string& text) {
  int bounces = -1;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), bounces);
  const bool is_number = result.ec == std::errc() && result.ptr == text.data() + text.size();
  return is_number && bounces >= 0 && bounces <= render::kMaxBounces ? std::optional(bounces) : std::nullopt;
}

std::string shard_problem(const std::string& text) {
  const auto shard = two_numbers(text, '/');
  const bool is_good = shard && shard->first >= 1 && shard->first <= shard->second;
  return is_good ? std::string() : "'" + text + "' is not a shard like 3/16 (1/16 to 16/16)";
}

std::vector<std::string> layer_names() {
  std::vector<std::string> names;
  for (const render::Layer layer : render::all_layers()) names.emplace_back(render::layer_name(layer));
  return names;
}

}  // namespace

std::optional<Size> parse_size(const std::string& text) {
  const auto numbers = two_numbers(text, 'x');
  return numbers ? std::optional<Size>({numbers->first, numbers->second}) : std::nullopt;
}

void add_options(CLI::App& command, RenderArguments& arguments) {
  command
      .add_option("SCENE", arguments.scene,
                  "A file (.obj .ply .stl .gltf .glb .pbrt) or a\n"
                  "scene that the program makes itself, see below")
      ->capture_default_str();
  command
      .add_option("-o,--output", arguments.outputs,
                  "The picture: .png; .exr or .hdr keep all light.\nMay be given more than once")
      ->default_str("picture.png")
      ->allow_extra_args(false)
      ->check(picture_ending_problem);
  command
      .add_option("--size", arguments.size,
                  "WIDTHxHEIGHT in pixels; without it the file's own,\nelse 1280x720")
      ->check([](const std::string& text) {
        return parse_size(text) ? std::string() : "'" + text + "' is not a size like 1280x720";
      });
  command
      .add_option("--samples", arguments.samples,
                  "Rays through each pixel, 64 unless given; powers\nof two look best. With --noise or "
                  "--time: at most")
      ->check(CLI::Range(1, render::kMaxSamples).description(""));
  command
      .add_option("--noise", arguments.noise,
                  "Go on where the picture is noisier than this:\n0.02 is 2% of the brightness")
      ->check(CLI::Range(1e-6, 10.0).description(""));
  command.add_option("--time", arguments.seconds, "Render for so many seconds at most")
      ->check(CLI::Range(0.001, 1e9).description(""));
  command.add_option("--mode", arguments.mode, "path (light), color, normal, depth, occlusion,\ncost")
      ->capture_default_str()
      ->check(CLI::IsMember({"path", "color", "normal", "depth", "occlusion", "cost"}).description(""));
  command
      .add_option("--bounces", arguments.bounces,
                  "Bounces of a path at most, 64 unless given;\nfile: as many as the scene's file asks for")
      ->check([](const std::string& text) {
        return text == kAsTheFile || parse_bounces(text)
                   ? std::string()
                   : "'" + text + "' is neither a number from 0 to 64 nor 'file'";
      });
  command
      .add_option(
          "--layers", arguments.layers,
          "What else an .exr holds of each pixel, with commas\nbetween: " +
              std::string("albedo, normal, depth, position,\nobject, material, samples, variance; or all"))
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check([](const std::string& name) {
        try {
          if (name != "all") (void)render::layer_from_name(name);
          return std::string();
        } catch (const std::invalid_argument& error) {
          return std::string(error.what());
        }
      });
  command
      .add_option("--filter", arguments.filter,
                  "How light beside a pixel counts: box, tent,\ngaussian, mitchell, blackman-harris")
      ->capture_default_str()
      ->check(CLI::IsMember({"box", "tent", "gaussian", "mitchell", "blackman-harris"}).description(""));
  add_look_options(command, arguments.look);
  command.add_option("--preview", arguments.preview, "A picture that is replaced as the render goes on")
      ->check(picture_ending_problem);
  command
      .add_option("--checkpoint", arguments.checkpoint_seconds,
                  "Seconds between checkpoints beside the picture;\n0: none")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e9).description(""));
  command.add_flag("--resume", arguments.is_resumed, "Go on from the checkpoint, if there is one");
  command
      .add_option("--shard", arguments.shard,
                  "Render a share of the samples, such as 3/16, for\nboxwood merge")
      ->check(shard_problem);
  command
      .add_option("--threads", arguments.threads,
                  "How many threads work; 0 means all. The picture is\nthe same")
      ->capture_default_str()
      ->check(CLI::Range(0, 4096).description(""));
  command.add_option("--build", arguments.build, "Care that the tree gets: fast, balanced, best")
      ->capture_default_str()
      ->check(CLI::IsMember({"fast", "balanced", "best"}).description(""));
  command.add_flag("--quiet", arguments.is_quiet, "No progress; only warnings and errors");
}

void check_together(const RenderArguments& arguments) {
  const auto refuse = [](const std::string& what) { throw CLI::ValidationError(what); };
  bool has_exr = false;
  for (const std::string& output : arguments.outputs) has_exr |= io::lower_extension(output) == ".exr";
  if (!arguments.layers.empty() && !has_exr)
    refuse("--layers needs an .exr to write them to, not " + joined(arguments.outputs));
  if (arguments.shard.empty()) return;
  if (arguments.outputs.size() != 1 || !has_exr)
    refuse("--shard writes one .exr for boxwood merge, not " + joined(arguments.outputs));
  if (arguments.noise > 0 || arguments.seconds > 0)
    refuse("--shard is a fixed share of the samples, which --noise and --time are not");
  if (arguments.look.is_half) refuse("--shard keeps all bits; give --half to boxwood merge");
}

render::RenderOptions options_from(const RenderArguments& arguments) {
  render::RenderOptions options;
  options.mode = render::mode_from_name(arguments.mode);
  options.filter = render::filter_from_name(arguments.filter);
  options.bounces = parse_bounces(arguments.bounces).value_or(render::kMaxBounces);
  options.noise = arguments.noise;
  options.samples = arguments.samples > 0   ? arguments.samples
                    : arguments.noise > 0   ? kNoiseLimit
                    : arguments.seconds > 0 ? render::kMaxSamples
                                            : kDefaultSamples;
  std::vector<std::string> names = arguments.layers;
  if (names == std::vector<std::string>{"all"}) names = layer_names();
  for (const std::string& name : names) options.layers.push_back(render::layer_from_name(name));
  if (const auto shard = two_numbers(arguments.shard, '/')) options.shard = {shard->first, shard->second};
  if (const std::optional<Size> size = parse_size(arguments.size)) {
    options.width = size->width;
    options.height = size->height;
  }
  return options;
}

}  // namespace boxwood::app
