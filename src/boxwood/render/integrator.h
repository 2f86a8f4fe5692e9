// integrator.h: what does one sample of a pixel see?
//
// The interface between the pixel loop (render.cpp) and the modes (aov.cpp, path.cpp).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "boxwood/core/ray.h"
#include "boxwood/render/sampler.h"

namespace boxwood::render {

/// How many rays a sample traced, by what they asked.
struct RayCounts {
  std::uint32_t camera = 0;  ///< The closest hit, from the camera.
  std::uint32_t bounce = 0;  ///< The closest hit, from a surface.
  std::uint32_t shadow = 0;  ///< Whether anything is in the way.
  std::uint64_t total() const { return std::uint64_t(camera) + bounce + shadow; }
  friend bool operator==(const RayCounts&, const RayCounts&) = default;
};

/// Read-only while rendering: any number of threads call sample() at once.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// How many floats a sample has; at most kMaxMainChannels (film.h).
  virtual int channels() const = 0;
  /// Fills `out` with what is seen along `ray`, and adds the rays it traced to `rays`. False when there is
  /// nothing to count (the pixel's mean is then that of its other samples).
  virtual bool sample(const Ray& ray, Sampler& sampler, std::span<float> out, RayCounts& rays) const = 0;

  /// The same for many rays at once, with the same answers: `out` has channels() floats for each, `rays` its
  /// counts, and `is_counted` what sample() returns. Modes that gain by tracing rays in batches do so here.
  virtual void sample_many(std::span<const Ray> camera_rays, std::span<Sampler> samplers,
                           std::span<float> out, std::span<bool> is_counted,
                           std::span<RayCounts> rays) const {
    const auto width = static_cast<std::size_t>(channels());
    for (std::size_t i = 0; i < camera_rays.size(); ++i)
      is_counted[i] = sample(camera_rays[i], samplers[i], out.subspan(i * width, width), rays[i]);
  }
};

/// For samples of three floats.
inline void store(std::span<float> out, Vec3 v) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

}  // namespace boxwood::render
