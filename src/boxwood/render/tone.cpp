#include "boxwood/render/tone.h"

#include <cmath>
#include <stdexcept>

#include "boxwood/core/vec.h"

namespace boxwood::render {
namespace {

constexpr std::string_view kNames[] = {"linear", "reinhard", "filmic"};

/// Luminance of the primaries of sRGB (Rec. 709).
constexpr float kLuminance[] = {0.2126f, 0.7152f, 0.0722f};

/// By how much the pixel's light is to be multiplied. Reinhard, Stark, Shirley and Ferwerda, "Photographic
/// Tone Reproduction for Digital Images", 2002, equation 4, with 4 for white.
float reinhard(const float* pixel, int channels) {
  float light = 0;
  for (int c = 0; c < channels; ++c) light += (channels == 3 ? kLuminance[c] : 1) * pixel[c];
  return light > 0 ? (1 + light / 16) / (1 + light) : 1;
}

/// Narkowicz's fit of the ACES reference curve, 2015.
float filmic(float x) {
  x = max(x, 0.0f);
  // For what is far beyond white the fractions would be infinite over infinite.
  return x < 1e6f ? x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f) : 1;
}

}  // namespace

Image toned(const Image& light, float exposure_stops, Tone tone) {
  Image picture = light;
  const float exposure = std::exp2(exposure_stops);
  for (std::size_t i = 0; i < picture.pixels.size(); i += static_cast<std::size_t>(picture.channels)) {
    float* pixel = &picture.pixels[i];
    for (int c = 0; c < picture.channels; ++c) pixel[c] *= exposure;
    const float factor = tone == Tone::reinhard ? reinhard(pixel, picture.channels) : 1;
    for (int c = 0; c < picture.channels; ++c)
      pixel[c] = tone == Tone::filmic ? filmic(pixel[c]) : pixel[c] * factor;
  }
  return picture;
}

std::string_view tone_name(Tone tone) {
  return kNames[static_cast<std::size_t>(tone)];
}

Tone tone_from_name(std::string_view name) {
  for (const Tone tone : {Tone::linear, Tone::reinhard, Tone::filmic})
    if (tone_name(tone) == name) return tone;
  throw std::invalid_argument("'" + std::string(name) +
                              "' is not a tone curve; expected one of linear, reinhard, filmic");
}

}  // namespace boxwood::render
