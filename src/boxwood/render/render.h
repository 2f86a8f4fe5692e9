// render.h: how does a scene become a picture? The front door of the room.
//
// The picture is refined in passes (1, 1, 2, 4, ... samples a pixel, at most 16 at once), each cut into tiles
// that the executor shares out. So a render that is stopped early returns a whole, only noisier, picture.
// Every sample is a pure function of (scene, options, pixel, sample): the same bits for any number of
// threads.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "boxwood/core/parallel.h"
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
  double done = 0;         ///< The share of all samples, in [0, 1].
  std::uint64_t rays = 0;  ///< Traced so far, of every kind.
};

inline constexpr int kMaxSide = 32768;                 ///< Pixels on a side of a picture.
inline constexpr std::int64_t kMaxPixels = 1ll << 27;  ///< Pixels of a picture.
inline constexpr int kMaxSamples = 1 << 20;            ///< Samples of a pixel.

struct RenderOptions {
  Mode mode = Mode::path;
  int width = 1280, height = 720;
  int samples = 64;  ///< Rays through each pixel; powers of two are spread best. One goes through the middle.
  Executor* executor = nullptr;  ///< Who works; nullptr means default_executor() (oneTBB).
  /// Told now and then, from one thread at a time. Returning false stops the render, which keeps what it has.
  std::function<bool(const RenderStatus&)> progress;
};

struct RenderResult {
  Image image;              ///< As Mode says; linear, not meant for the eye (see displayable).
  bool is_complete = true;  ///< False when `progress` stopped it.
  std::uint64_t rays = 0;
  std::uint64_t dropped_samples = 0;  ///< Samples that were not finite, and were left out.
};

/// Throws std::invalid_argument when a size or the number of samples is out of range.
void check(const RenderOptions& options);

/// Throws std::invalid_argument as check() does, and when the scene's camera is not usable.
RenderResult render_picture(const Scene& scene, const RenderOptions& options = {});

/// What an eye can make sense of, with values in [0, 1] for an 8-bit file: normals as colors, depth and
/// occlusion as greys, lighter when nearer and when open, cost in false colors with a legend. Others as they
/// are.
Image displayable(const Image& image, Mode mode);

/// "path", "color" ...; and back. Throws std::invalid_argument for a name that is not one of them.
std::string_view mode_name(Mode mode);
Mode mode_from_name(std::string_view name);

}  // namespace boxwood::render
