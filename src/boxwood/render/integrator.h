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

/// Read-only while rendering: any number of threads call sample() at once.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// How many floats a sample has; at most Film::kMaxChannels.
  virtual int channels() const = 0;
  /// Fills `out` with what is seen along `ray`, and adds the rays it traced to `rays`. False when there is
  /// nothing to count (the pixel's mean is then that of its other samples).
  virtual bool sample(const Ray& ray, Sampler& sampler, std::span<float> out, std::uint64_t& rays) const = 0;
};

/// For samples of three floats.
inline void store(std::span<float> out, Vec3 v) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

}  // namespace boxwood::render
