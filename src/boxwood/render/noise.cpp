#include "boxwood/render/noise.h"

#include <array>

namespace boxwood::render {

std::optional<PixelNoise> pixel_noise(const TileSums& sums, std::size_t pixel) {
  const double all_count = sums.count(pixel, 0), half_count = sums.count(pixel, 1);
  const double other_count = all_count - half_count;
  if (!(half_count > 0) || !(other_count > 0)) return std::nullopt;

  std::array<double, kMaxMainChannels> channels{};
  sums.read(pixel, 0, channels);
  double all = 0, half = 0;
  for (int c = 0; c < sums.channels(0); ++c) all += channels[static_cast<std::size_t>(c)];
  all /= sums.channels(0);
  sums.read(pixel, 1, {&half, 1});

  // With n and m samples in the halves, the mean's variance is that of their difference times nm / (n + m)^2.
  const double difference = half / half_count - (all - half) / other_count;
  return PixelNoise{all / all_count,
                    difference * difference * half_count * other_count / (all_count * all_count)};
}

double tile_error(const TileSums& sums, double floor) {
  double error = 0;
  for (std::size_t pixel = 0; pixel < sums.pixel_count(); ++pixel) {
    const std::optional<PixelNoise> found = pixel_noise(sums, pixel);
    if (found && found->variance > 0)
      error += found->variance / (found->brightness * found->brightness + floor);
  }
  return error;
}

double error_floor(const Film& film) {
  double sum = 0;
  for (std::size_t tile = 0; tile < film.grid().size(); ++tile)
    film.with_tile(tile, [&sum](const Film::Tile& held) {
      for (std::size_t pixel = 0; pixel < held.sums.pixel_count(); ++pixel)
        if (const std::optional<PixelNoise> found = pixel_noise(held.sums, pixel)) sum += found->brightness;
    });
  const double mean = sum / (double(film.grid().width) * film.grid().height);
  return 0.01 * mean * mean;
}

}  // namespace boxwood::render
