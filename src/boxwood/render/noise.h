// noise.h: how far may a picture still be from the one with endlessly many samples?
//
// The samples of a pixel are split into halves, and the halves' difference tells the error of their mean, as
// in Dammertz et al., "A Hierarchical Automatic Stopping Condition for Monte Carlo Global Illumination",
// 2010. Blocks of eight consecutive samples go to the two halves in turn, since such a block is a net of its
// own and single samples of a net are not independent. The difference of two numbers is a poor witness alone,
// so only means over the pixels of a tile are trusted.
//
// The noise of a set of pixels is the root of the mean of variance / (brightness^2 + floor): the square root
// of what `relative MSE` would be against the finished picture. 0.02 is an error of 2% of the brightness.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "boxwood/render/film.h"

namespace boxwood::render {

inline constexpr int kHalfBlock = 8;                   ///< Samples that go to one half together.
inline constexpr int kLeastForNoise = 2 * kHalfBlock;  ///< Samples before which nothing can be said.

/// Whether a sample belongs to the half that is added up apart.
inline bool is_in_half(int sample) {
  return (sample / kHalfBlock) % 2 != 0;
}

/// A pixel's brightness (the mean of its channels), and the variance of that as an estimate.
struct PixelNoise {
  double brightness = 0, variance = 0;
};

/// Of a pixel whose group 0 holds all samples and group 1 the brightness of a half. Nothing without both
/// halves.
std::optional<PixelNoise> pixel_noise(const TileSums& sums, std::size_t pixel);

/// The sum over the tile's pixels of variance / (brightness^2 + floor).
double tile_error(const TileSums& sums, double floor);

/// The floor for a picture: 1% of the square of its mean brightness, so that black pixels, whose relative
/// error means nothing, do not count as noisy. Scaling a scene's light does not change its noise.
double error_floor(const Film& film);

}  // namespace boxwood::render
