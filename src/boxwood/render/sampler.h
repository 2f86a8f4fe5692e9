// sampler.h: which numbers does a sample of a pixel draw?
//
// A pure function of (pixel, sample, dimension), so a picture has the same bits whatever the threads did.
// Each pair of dimensions is the two-dimensional Sobol sequence, scrambled and shuffled anew for each pixel
// and each pair by hashed Owen scrambling: Burley, "Practical Hash-based Owen Scrambling", JCGT 2020, with
// the permutation by Laine and Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011.
//
// Invariant: the first 2^k samples of a pixel,
// in each pair of dimensions, hit each of the 2^k elementary boxes once.
#pragma once

#include <cstdint>

#include "boxwood/core/vec.h"

namespace boxwood::render {

/// Mixes the bits of `x` so that inputs that differ in one bit look unrelated.
/// The finalizer "lowbias32" (Wellons, 2018).
constexpr std::uint32_t hash_bits(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

constexpr std::uint32_t hash_bits(std::uint32_t a, std::uint32_t b) {
  return hash_bits(a ^ hash_bits(b + 0x9e3779b9u));
}

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

/// Owen scrambling: each bit of `x` is flipped or not by a hash of the bits above it. `reversed` is `x` with
/// its bits reversed, because multiplication carries upwards only; so is the result.
constexpr std::uint32_t owen_scramble_reversed(std::uint32_t reversed, std::uint32_t seed) {
  reversed ^= reversed * 0x3d20adeau;
  reversed += seed;
  reversed *= (seed >> 16) | 1u;
  reversed ^= reversed * 0x05526c56u;
  reversed ^= reversed * 0x53a22864u;
  return reversed;
}

/// The second coordinate of the Sobol sequence, its bits reversed. The direction numbers of that coordinate
/// are the rows of Pascal's triangle modulo 2, so the bits of the index, as a polynomial p(x) over them,
/// become those of p(x + 1); and as (x + 1)^n = x^n + 1 for powers of two, the upper half of each group of
/// bits is added to the lower half, for halves of 16, 8, 4, 2 and 1 bits.
constexpr std::uint32_t second_sobol_reversed(std::uint32_t index) {
  index ^= index >> 16;
  index ^= (index & 0xff00ff00u) >> 8;
  index ^= (index & 0xf0f0f0f0u) >> 4;
  index ^= (index & 0xccccccccu) >> 2;
  return index ^ ((index & 0xaaaaaaaau) >> 1);
}

/// Two numbers in [0, 1).
inline Vec2 draw(std::uint32_t pixel_seed, std::uint32_t reversed_index, std::uint32_t dimension) {
  const std::uint32_t seed = hash_bits(pixel_seed, dimension);
  // Shuffle: which point of the sequence this sample takes.
  const std::uint32_t index = reverse_bits(owen_scramble_reversed(reversed_index, seed));
  // Its first coordinate is the index with its bits reversed, so the reversed coordinate is the index itself.
  const std::uint32_t x = reverse_bits(owen_scramble_reversed(index, hash_bits(seed, 1)));
  const std::uint32_t y =
      reverse_bits(owen_scramble_reversed(second_sobol_reversed(index), hash_bits(seed, 2)));
  // Of the bits that a float can hold; signed, since that is what processors convert.
  const auto to_unit = [](std::uint32_t bits) {
    return static_cast<float>(static_cast<std::int32_t>(bits >> 8)) * 0x1p-24f;
  };
  return {to_unit(x), to_unit(y)};
}

/// The numbers of one sample of one pixel, drawn in a fixed order.
class Sampler {
 public:
  Sampler(std::uint32_t pixel_index, std::uint32_t sample_index)
      : pixel_seed_(hash_bits(pixel_index, 0x5eed)), reversed_index_(reverse_bits(sample_index)) {}

  /// In [0, 1).
  float next_1d() { return next_2d().x; }

  /// Both in [0, 1).
  Vec2 next_2d() { return draw(pixel_seed_, reversed_index_, dimension_++); }

  /// Leaves out `count` draws.
  void skip(std::uint32_t count) { dimension_ += count; }

 private:
  friend class Draws;
  std::uint32_t pixel_seed_, reversed_index_, dimension_ = 0;
};

}  // namespace boxwood::render
