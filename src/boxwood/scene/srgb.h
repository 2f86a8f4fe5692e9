// srgb.h: how is light written as a code that is even to the eye?
//
// By the curve of IEC 61966-2-1. Pictures in memory hold linear light, textures and 8-bit files hold codes.
#pragma once

#include <cmath>

namespace boxwood {

/// The code in [0, 1] to linear light in [0, 1].
inline float linear_from_srgb(float code) {
  return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f);
}

/// Linear light to its code.
inline float srgb_from_linear(float light) {
  return light <= 0.0031308f ? 12.92f * light : 1.055f * std::pow(light, 1 / 2.4f) - 0.055f;
}

}  // namespace boxwood
