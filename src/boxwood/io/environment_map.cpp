#include "boxwood/io/environment_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "boxwood/core/error.h"
#include "boxwood/io/image.h"

namespace boxwood::io {
namespace {

constexpr double kPi = 3.14159265358979323846;

Image unfold(const Image& square) {
  Image out(2 * square.width, square.width, 3);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      // The mean of four points of the pixel, since the square is finer in places.
      for (int part = 0; part < 4; ++part) {
        const double longitude = 2 * kPi * (x + 0.25 + 0.5 * (part % 2)) / out.width,
                     latitude = kPi * (y + 0.25 + 0.5 * (part / 2)) / out.height;
        const double sine = std::sin(latitude);
        const auto [u, v] =
            equal_area_square({sine * std::cos(longitude), sine * std::sin(longitude), std::cos(latitude)});
        const int column = std::clamp(static_cast<int>(u * square.width), 0, square.width - 1),
                  row = std::clamp(static_cast<int>(v * square.height), 0, square.height - 1);
        for (int c = 0; c < 3; ++c) out.at(x, y)[c] += 0.25f * square.at(column, row)[c];
      }
    }
  return out;
}

}  // namespace

std::array<double, 2> equal_area_square(std::array<double, 3> direction) {
  const double x = std::fabs(direction[0]), y = std::fabs(direction[1]), z = std::fabs(direction[2]);
  const double radius = std::sqrt(std::max(0.0, 1 - z));
  const double larger = std::max(x, y), smaller = std::min(x, y);
  double angle = larger > 0 ? std::atan(smaller / larger) * 2 / kPi : 0;
  if (x < y) angle = 1 - angle;
  double v = angle * radius, u = radius - v;
  if (direction[2] < 0) {  // the lower half is folded outwards
    std::swap(u, v);
    u = 1 - u;
    v = 1 - v;
  }
  u = std::copysign(u, direction[0]);
  v = std::copysign(v, direction[1]);
  return {(u + 1) / 2, (v + 1) / 2};
}

Image read_environment(const std::filesystem::path& path, std::size_t& mended) {
  const Image file = read_image(path);
  Image out(file.width, file.height, 3);
  for (std::size_t i = 0; i < std::size_t(file.width) * file.height; ++i)
    for (int c = 0; c < 3; ++c) {
      // One channel is a grey.
      const float value = file.pixels[i * file.channels + (file.channels >= 3 ? c : 0)];
      const bool is_usable = value >= 0 && value <= std::numeric_limits<float>::max();
      mended += !is_usable;
      out.pixels[3 * i + c] = is_usable ? value : 0;
    }
  return out.width == out.height && out.width > 1 ? unfold(out) : out;
}

}  // namespace boxwood::io
