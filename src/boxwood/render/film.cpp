#include "boxwood/render/film.h"

#include <cmath>
#include <cstdint>

namespace boxwood::render {

Film::Film(int width, int height, int channels)
    : width_(width), height_(height), channels_(channels), pixels_(std::size_t(width) * height) {}

void Film::add(int x, int y, std::span<const float> sample, std::uint64_t& dropped) {
  for (const float value : sample) {
    if (!std::isfinite(value)) {
      ++dropped;
      return;
    }
  }
  Pixel& pixel = pixels_[std::size_t(y) * width_ + x];
  for (std::size_t c = 0; c < sample.size(); ++c) pixel.sum[c] += sample[c];
  ++pixel.count;
}

Image Film::average() const {
  Image image(width_, height_, channels_);
  float* out = image.pixels.data();
  for (const Pixel& pixel : pixels_)
    for (int c = 0; c < channels_; ++c)
      *out++ = pixel.count == 0 ? 0 : static_cast<float>(pixel.sum[c] / pixel.count);
  return image;
}

}  // namespace boxwood::render
