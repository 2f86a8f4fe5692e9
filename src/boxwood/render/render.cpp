#include "boxwood/render/render.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "boxwood/render/aov.h"
#include "boxwood/render/false_color.h"
#include "boxwood/render/job.h"

namespace boxwood::render {
namespace {

struct NamedMode {
  Mode mode;
  std::string_view name;
};
constexpr NamedMode kModes[] = {{Mode::path, "path"},           {Mode::color, "color"},
                                {Mode::normal, "normal"},       {Mode::depth, "depth"},
                                {Mode::occlusion, "occlusion"}, {Mode::cost, "cost"}};

}  // namespace

void check(const RenderOptions& options) {
  const auto fail = [](const std::string& what) { throw std::invalid_argument("render: " + what); };
  if (options.width < 1 || options.height < 1 || options.width > kMaxSide || options.height > kMaxSide)
    fail("the size is " + std::to_string(options.width) + "x" + std::to_string(options.height) +
         " pixels, expected 1 to " + std::to_string(kMaxSide) + " on each side");
  if (std::int64_t(options.width) * options.height > kMaxPixels)
    fail("the size is " + std::to_string(options.width) + "x" + std::to_string(options.height) +
         ", expected at most " + std::to_string(kMaxPixels) + " pixels in all");
  if (options.samples < 1 || options.samples > kMaxSamples)
    fail(std::to_string(options.samples) + " samples, expected 1 to " + std::to_string(kMaxSamples));
  if (options.bounces < 0 || options.bounces > kMaxBounces)
    fail(std::to_string(options.bounces) + " bounces, expected 0 to " + std::to_string(kMaxBounces));
  if (!(options.noise >= 0) || !std::isfinite(options.noise))
    fail("the noise is " + std::to_string(options.noise) + ", expected 0 or more");

  const auto [index, count] = options.shard;
  const std::string shard = std::to_string(index) + "/" + std::to_string(count);
  if (count < 1 || index < 1 || index > count)
    fail("the shard is " + shard + ", expected one from 1/N to N/N");
  if (count > options.samples)
    fail("the shard is " + shard + ", but there are only " + std::to_string(options.samples) + " samples");
  if (count > 1 && options.noise > 0)
    fail("a shard cannot stop at a noise, because it does not see the samples of the others");
  for (std::size_t i = 0; i < options.layers.size(); ++i)
    if (std::find(options.layers.begin(), options.layers.begin() + static_cast<std::ptrdiff_t>(i),
                  options.layers[i]) != options.layers.begin() + static_cast<std::ptrdiff_t>(i))
      fail("the layer " + std::string(layer_name(options.layers[i])) + " is asked for twice");
}

RenderResult render_picture(const Scene& scene, const RenderOptions& options) {
  return RenderJob(scene, options).run();
}

std::vector<std::string> mode_channels(Mode mode) {
  switch (mode) {
    case Mode::normal:
      return {"normal.X", "normal.Y", "normal.Z"};
    case Mode::depth:
      return {"depth.Z"};
    case Mode::occlusion:
      return {"Y"};
    case Mode::cost:
      return {"box_tests", "shape_tests"};
    default:
      return {"R", "G", "B"};
  }
}

Image without_layers(const Image& image, Mode mode) {
  const std::vector<std::string> names = mode_channels(mode);
  if (image.channels == static_cast<int>(names.size())) return image;
  Image first(image.width, image.height, static_cast<int>(names.size()));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) std::copy_n(image.at(x, y), names.size(), first.at(x, y));
  first.channel_names = names;
  return first;
}

Image displayable(const Image& image, Mode mode) {
  const Image shown = without_layers(image, mode);
  switch (mode) {
    case Mode::normal:
      return normal_as_color(shown);
    case Mode::depth:
      return depth_as_grey(shown);
    case Mode::occlusion:
      return occlusion_as_grey(shown);
    case Mode::cost:
      return cost_as_color(shown);
    default:
      return shown;
  }
}

std::string_view mode_name(Mode mode) {
  for (const NamedMode& named : kModes)
    if (named.mode == mode) return named.name;
  return "";
}

Mode mode_from_name(std::string_view name) {
  std::string known;
  for (const NamedMode& named : kModes) {
    if (named.name == name) return named.mode;
    known += (known.empty() ? "" : ", ") + std::string(named.name);
  }
  throw std::invalid_argument("'" + std::string(name) + "' is not a mode; expected one of " + known);
}

}  // namespace boxwood::render
