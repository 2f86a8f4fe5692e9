// image.h: what is a picture in memory?
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace boxwood {

/// A picture: rows from top to bottom, `channels` floats a pixel, linear light (not sRGB encoded).
struct Image {
  int width = 0, height = 0, channels = 3;
  std::vector<float> pixels;  ///< height x width x channels.
  /// Empty, or one for each channel ("R", "G", "B", "depth.Z", ...).
  std::vector<std::string> channel_names;

  Image() = default;
  Image(int width, int height, int channels = 3)
      : width(width), height(height), channels(channels), pixels(std::size_t(width) * height * channels) {}

  float* at(int x, int y) { return &pixels[(std::size_t(y) * width + x) * channels]; }
  const float* at(int x, int y) const { return &pixels[(std::size_t(y) * width + x) * channels]; }
};

}  // namespace boxwood
