// render.h: how does a scene become a picture? The front door of the room.
//
// A picture is refined in rounds of samples (rounds.h), each cut into units that the executor shares out. So
// a render that is stopped early returns a whole, only noisier, picture. Every sample is a pure function of
// (scene, options, pixel, sample), and sums are exact (film.h): the same bits for any number of threads.
// Who wants to look at a picture while it is made, or to keep it and go on later, uses job.h.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "boxwood/core/parallel.h"
#include "boxwood/render/filter.h"
#include "boxwood/render/layer.h"
#include "boxwood/scene/image.h"
#include "boxwood/scene/scene.h"

namespace boxwood::render {

enum class Mode {
  path,       ///< Light: radiance along the pixel's rays, by path tracing.
  color,      ///< The base color of what the pixel's ray hits, without any light.
  normal,     ///< The shading normal there, in world space, each component in [-1, 1].
  depth,      ///< The distance to it, in scene units; 0 where nothing is hit.
  occlusion,  ///< How open it is to its surroundings: 1 open, 0 shut in or nothing hit.
  cost,       ///< How many boxes and shapes the ray was tested against (two channels).
};

/// How far a render is.
struct RenderStatus {
  double done = 0;              ///< The share of all samples, in [0, 1]; a forecast when there is a noise
                                ///< target, and 0 before there can be one.
  std::uint64_t rays = 0;       ///< Traced so far, of every kind.
  double samples = 0;           ///< Of each pixel so far, on average.
  std::optional<double> noise;  ///< As of the last round (noise.h); nothing before there are enough samples.
  bool is_whole = false;        ///< Every pixel has a sample.
};

/// One of `count` shares of the samples; `index` is 1 to `count`.
struct Shard {
  int index = 1, count = 1;
};

inline constexpr int kMaxSide = 32768;                 ///< Pixels on a side of a picture.
inline constexpr std::int64_t kMaxPixels = 1ll << 27;  ///< Pixels of a picture.
inline constexpr int kMaxSamples = 1 << 20;            ///< Samples of a pixel.
inline constexpr int kMaxBounces = 64;                 ///< Of a path; roulette ends most long before.

struct RenderOptions {
  Mode mode = Mode::path;
  int width = 1280, height = 720;
  int samples = 64;  ///< Rays through each pixel; powers of two are spread best. One goes through the middle.
  /// Light that is scattered more often than this on its way to the eye is left out: 1 shows what lamps send
  /// by way of one surface, 0 only what shines itself. (A mirror scatters, too.)
  int bounces = kMaxBounces;
  Filter filter = Filter::tent;  ///< How far light counts beyond the edges of a pixel.
  std::vector<Layer> layers;     ///< What else the picture holds of each pixel, each at most once.
  /// Above 0, a tile gets no more samples when its noise (noise.h) is at most this; `samples` is then a
  /// limit.
  double noise = 0;
  Shard shard;                   ///< Render only this share of the samples; not together with `noise`.
  Executor* executor = nullptr;  ///< Who works; nullptr means default_executor() (oneTBB).
  /// Told now and then, from one thread at a time. Returning false stops the render, which keeps what it has.
  std::function<bool(const RenderStatus&)> progress;
};

struct RenderResult {
  Image image;  ///< As Mode says, then the layers; linear, not meant for the eye (see displayable).
  bool is_complete = true;  ///< False when `progress` stopped it.
  std::uint64_t rays = 0;
  std::uint64_t dropped_samples = 0;  ///< Samples that were not finite, and were left out.
  double samples = 0;                 ///< Of each pixel, on average.
  std::optional<double> noise;        ///< As in RenderStatus.
};

/// Throws std::invalid_argument when a size, a number of samples or another option is out of range.
void check(const RenderOptions& options);

/// Throws std::invalid_argument as check() does, and when the scene's camera is not usable.
RenderResult render_picture(const Scene& scene, const RenderOptions& options = {});

/// What the mode itself shows, without the layers behind it.
Image without_layers(const Image& image, Mode mode);

/// What an eye can make sense of, with values in [0, 1] for an 8-bit file: normals as colors, depth and
/// occlusion as greys, lighter when nearer and when open, cost in false colors with a legend. Others as they
/// are. Layers are left out.
Image displayable(const Image& image, Mode mode);

/// The names of the channels that a picture of this mode starts with: "R", "G", "B"; "depth.Z"; ...
std::vector<std::string> mode_channels(Mode mode);

/// "path", "color" ...; and back. Throws std::invalid_argument for a name that is not one of them.
std::string_view mode_name(Mode mode);
Mode mode_from_name(std::string_view name);

}  // namespace boxwood::render
