#include "boxwood/render/false_color.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "boxwood/render/lettering.h"
#include "boxwood/scene/srgb.h"

namespace boxwood::render {
namespace {

/// Nine stops of the color map "inferno" (Smith and van der Walt, for matplotlib, 2015; public domain): equal
/// steps of the number look like equal steps of lightness. sRGB codes.
constexpr int kStops[][3] = {{0, 0, 4},     {33, 12, 74},  {87, 16, 110},  {138, 34, 106}, {188, 55, 84},
                             {228, 90, 49}, {249, 142, 9}, {249, 203, 53}, {252, 255, 164}};
constexpr int kLastStop = static_cast<int>(std::size(kStops)) - 1;

/// The smallest of 1, 2, 4, 8 times a power of ten that is at least `value` and has whole quarters.
int round_up_nicely(float value) {
  for (int decade = 1;; decade *= 10)
    for (const int digit : {1, 2, 4, 8}) {
      const int candidate = digit * decade;
      if (candidate % 4 == 0 && (static_cast<float>(candidate) >= value || candidate >= 800'000'000))
        return candidate;
    }
}

std::string with_one_decimal(double value) {
  const auto tenths = static_cast<long long>(std::llround(value * 10));
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

/// A bar of all colors with numbers at its quarters, and a line that says what is counted.
void draw_legend(Image& picture, int top_of_scale, double mean) {
  const std::string title = "boxes + shapes tested per ray, mean " + with_one_decimal(mean);
  const int scale = std::max(1, picture.height / 360);
  const int margin = 6 * scale, bar_height = 10 * scale, gap = 3 * scale, text_height = kGlyphHeight * scale;
  const int width = static_cast<int>(title.size()) * kGlyphWidth * scale;
  const int height = text_height + gap + bar_height + gap + text_height;
  if (width + 4 * margin > picture.width || height + 4 * margin > picture.height) return;

  // A dark panel, so that the words can be read on any color.
  const int left = 2 * margin, top = picture.height - 2 * margin - height;
  const Vec3 ink{0.9f, 0.9f, 0.9f};
  fill_rectangle(picture, left - margin, top - margin, left + width + margin, top + height + margin,
                 {0, 0, 0}, 0.75f);
  draw_text(picture, left, top, scale, title, ink);

  const int bar_top = top + text_height + gap;
  for (int x = 0; x < width; ++x)
    fill_rectangle(picture, left + x, bar_top, left + x + 1, bar_top + bar_height,
                   false_color(static_cast<float>(x) / static_cast<float>(width - 1)));

  // Numbers under the bar: the first starts where it starts, the last ends where it ends.
  for (int quarter = 0; quarter <= 4; ++quarter) {
    std::string number = std::to_string(static_cast<long long>(top_of_scale) * quarter / 4);
    if (quarter == 4) number += "+";
    const int number_width = static_cast<int>(number.size()) * kGlyphWidth * scale - scale;
    const int x = left + (width - number_width) * quarter / 4;
    draw_text(picture, x, bar_top + bar_height + gap, scale, number, ink);
  }
}

}  // namespace

Vec3 false_color(float share) {
  const float x = min(max(share, 0.0f), 1.0f) * kLastStop;
  const int stop = std::min(static_cast<int>(x), kLastStop - 1);
  Vec3 color;
  for (int c = 0; c < 3; ++c) {
    const float a = static_cast<float>(kStops[stop][c]), b = static_cast<float>(kStops[stop + 1][c]);
    color[c] = linear_from_srgb((a + (b - a) * (x - static_cast<float>(stop))) / 255);
  }
  return color;
}

Image cost_as_color(const Image& cost) {
  std::vector<float> tests(std::size_t(cost.width) * cost.height);
  double sum = 0;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    tests[i] = cost.pixels[2 * i] + cost.pixels[2 * i + 1];
    sum += tests[i];
  }
  if (tests.empty()) return Image(cost.width, cost.height, 3);

  // Silhouettes cost far more than all else, and must not make everything else black.
  std::vector<float> ranked = tests;
  const auto almost_last = ranked.begin() + static_cast<std::ptrdiff_t>((ranked.size() - 1) * 0.99);
  std::nth_element(ranked.begin(), almost_last, ranked.end());
  const int top_of_scale = round_up_nicely(*almost_last);

  Image picture(cost.width, cost.height, 3);
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const Vec3 color = false_color(tests[i] / static_cast<float>(top_of_scale));
    for (int c = 0; c < 3; ++c) picture.pixels[3 * i + static_cast<std::size_t>(c)] = color[c];
  }
  draw_legend(picture, top_of_scale, sum / static_cast<double>(tests.size()));
  return picture;
}

}  // namespace boxwood::render
