#include "boxwood/render/render.h"

#include <array>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <string>

#include "boxwood/render/aov.h"
#include "boxwood/render/camera.h"
#include "boxwood/render/false_color.h"
#include "boxwood/render/film.h"
#include "boxwood/render/path.h"
#include "boxwood/render/warp.h"

namespace boxwood::render {
namespace {

constexpr int kTileSide = 16;
// Samples a pixel; keeps a tile, and so the reaction to a stop, well below a second.
constexpr int kMaxPass = 16;

struct NamedMode {
  Mode mode;
  std::string_view name;
};
constexpr NamedMode kModes[] = {{Mode::path, "path"},           {Mode::color, "color"},
                                {Mode::normal, "normal"},       {Mode::depth, "depth"},
                                {Mode::occlusion, "occlusion"}, {Mode::cost, "cost"}};

std::vector<std::string> channel_names(Mode mode) {
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

/// One render: what all passes and tiles share.
class Render {
 public:
  Render(const Scene& scene, const RenderOptions& options)
      : options_(options),
        camera_(choose_camera(scene.description(), options.width, options.height)),
        lens_(camera_, options.width, options.height),
        integrator_(options.mode == Mode::path ? make_path_tracer(scene, camera_)
                                               : make_aov(scene, options.mode)),
        film_(options.width, options.height, integrator_->channels()),
        tiles_across_((options.width + kTileSide - 1) / kTileSide),
        tiles_down_((options.height + kTileSide - 1) / kTileSide) {}

  RenderResult run() {
    Executor& executor = options_.executor ? *options_.executor : default_executor();
    const auto tiles = static_cast<std::size_t>(tiles_across_) * tiles_down_;
    for (int first = 0, count = 1; first < options_.samples && !is_stopped_; first += count) {
      // Each pass as large as all before it together, within a bound.
      count = std::min({std::max(first, 1), kMaxPass, options_.samples - first});
      parallel_for(executor, 0, tiles, 1, [&](std::size_t tile) {
        if (!is_stopped_) render_tile(static_cast<int>(tile), first, count);
      });
    }

    RenderResult result;
    result.image = film_.average();
    result.image.channel_names = channel_names(options_.mode);
    result.is_complete = !is_stopped_;
    result.rays = rays_;
    result.dropped_samples = dropped_;
    return result;
  }

 private:
  void render_tile(int tile, int first_sample, int sample_count) {
    const int x0 = tile % tiles_across_ * kTileSide, x1 = std::min(x0 + kTileSide, options_.width);
    const int y0 = tile / tiles_across_ * kTileSide, y1 = std::min(y0 + kTileSide, options_.height);
    std::uint64_t rays = 0, dropped = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        for (int s = first_sample; s < first_sample + sample_count; ++s)
          render_sample(x, y, s, rays, dropped);
    report(rays, dropped, std::int64_t(x1 - x0) * (y1 - y0) * sample_count);
  }

  void render_sample(int x, int y, int sample, std::uint64_t& rays, std::uint64_t& dropped) {
    Sampler sampler(static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(options_.width) +
                        static_cast<std::uint32_t>(x),
                    static_cast<std::uint32_t>(sample));
    // The pixel's filter is a tent two pixels wide, and samples are spread by it instead of weighed by it:
    // each belongs to one pixel only (Ernst, Stamminger and Greiner, "Filter Importance Sampling", 2006).
    const Vec2 jitter = sampler.next_2d(), lens = sampler.next_2d();
    Vec2 film{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
    if (options_.samples > 1) film = {film.x + tent(jitter.x), film.y + tent(jitter.y)};

    std::array<float, Film::kMaxChannels> value{};
    const auto channels = static_cast<std::size_t>(integrator_->channels());
    if (integrator_->sample(lens_.ray(film, lens), sampler, value, rays))
      film_.add(x, y, std::span(value).first(channels), dropped);
  }

  /// Adds up what a tile did, and tells `progress` when no other thread is telling it right now.
  void report(std::uint64_t rays, std::uint64_t dropped, std::int64_t samples) {
    rays_ += rays;
    dropped_ += dropped;
    samples_ += samples;
    if (!options_.progress) return;
    const std::unique_lock lock(progress_mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return;
    const double all = double(options_.width) * options_.height * options_.samples;
    if (!options_.progress({static_cast<double>(samples_) / all, rays_})) is_stopped_ = true;
  }

  const RenderOptions& options_;
  Camera camera_;
  Lens lens_;
  std::unique_ptr<Integrator> integrator_;
  Film film_;
  int tiles_across_, tiles_down_;
  std::mutex progress_mutex_;
  std::atomic<bool> is_stopped_ = false;
  std::atomic<std::uint64_t> rays_ = 0, dropped_ = 0;
  std::atomic<std::int64_t> samples_ = 0;
};

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
}

RenderResult render_picture(const Scene& scene, const RenderOptions& options) {
  check(options);
  return Render(scene, options).run();
}

Image displayable(const Image& image, Mode mode) {
  switch (mode) {
    case Mode::normal:
      return normal_as_color(image);
    case Mode::depth:
      return depth_as_grey(image);
    case Mode::occlusion:
      return occlusion_as_grey(image);
    case Mode::cost:
      return cost_as_color(image);
    default:
      return image;
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
