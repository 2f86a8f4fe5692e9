#include "boxwood/render/picture.h"

#include <array>

#include "boxwood/render/noise.h"

namespace boxwood::render {
namespace {

/// A filter with negative lobes counts some samples with -1. Their sum is 0 only where there are hardly any.
void write_mean(const TileSums& sums, std::size_t pixel, std::size_t group, float* out) {
  const std::int32_t count = sums.count(pixel, group);
  std::array<double, kMaxMainChannels> channels{};
  sums.read(pixel, group, channels);
  for (int c = 0; c < sums.channels(group); ++c)
    out[c] = count != 0 ? static_cast<float>(channels[static_cast<std::size_t>(c)] / count) : 0;
}

}  // namespace

Image picture_of(const Film& film, Mode mode, std::span<const Layer> layers) {
  std::vector<std::string> names = mode_channels(mode);
  for (const Layer layer : layers)
    for (const std::string& name : layer_channels(layer)) names.push_back(name);
  Image image(film.grid().width, film.grid().height, static_cast<int>(names.size()));
  image.channel_names = std::move(names);

  for (std::size_t tile = 0; tile < film.grid().size(); ++tile) {
    const TileArea area = film.grid().area(tile);
    film.with_tile(tile, [&](const Film::Tile& held) {
      const TileSums& sums = held.sums;
      std::size_t pixel = 0;
      for (int y = area.y0; y < area.y1; ++y)
        for (int x = area.x0; x < area.x1; ++x, ++pixel) {
          float* out = image.at(x, y);
          write_mean(sums, pixel, 0, out);
          out += sums.channels(0);
          std::size_t group = 2;
          for (const Layer layer : layers) {
            if (is_mean(layer))
              write_mean(sums, pixel, group++, out);
            else if (layer == Layer::samples)
              *out = static_cast<float>(sums.samples(pixel));
            else if (layer == Layer::variance)
              *out = static_cast<float>(pixel_noise(sums, pixel).value_or(PixelNoise{}).variance);
            out += layer_channels(layer).size();
          }
        }
    });
  }
  return image;
}

void write_names(Image& image, const Scene& scene, const Lens& lens, const RenderOptions& options) {
  // Where each of these layers stands in a pixel.
  std::vector<std::pair<Layer, std::size_t>> places;
  std::size_t channel = mode_channels(options.mode).size();
  for (const Layer layer : options.layers) {
    if (is_name(layer)) places.emplace_back(layer, channel);
    channel += layer_channels(layer).size();
  }
  if (places.empty()) return;

  Executor& executor = options.executor ? *options.executor : default_executor();
  parallel_for(executor, 0, static_cast<std::size_t>(image.height), 1, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < image.width; ++x) {
      const Ray ray = lens.ray({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, {0.5f, 0.5f});
      for (const auto& [layer, at] : places) image.at(x, y)[at] = name_of_hit(scene, ray, layer);
    }
  });
}

}  // namespace boxwood::render
