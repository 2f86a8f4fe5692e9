// film.h: what has each pixel gathered so far?
//
// Sums and counts. A pixel is written by one thread at a time and its samples come in order, so the sums do
// not depend on how many threads there are; a picture that is stopped early divides each pixel by the samples
// that it got. Invariant: every sum is finite.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "boxwood/scene/image.h"

namespace boxwood::render {

class Film {
 public:
  static constexpr int kMaxChannels = 3;

  /// `channels` is 1 to kMaxChannels.
  Film(int width, int height, int channels);

  /// Adds one sample. One that is not finite is left out, and counted in `dropped`.
  void add(int x, int y, std::span<const float> sample, std::uint64_t& dropped);

  /// The mean of each pixel; a pixel without samples is 0.
  Image average() const;

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  struct Pixel {
    std::array<double, kMaxChannels> sum{};
    std::uint32_t count = 0;
  };

  int width_, height_, channels_;
  std::vector<Pixel> pixels_;
};

}  // namespace boxwood::render
