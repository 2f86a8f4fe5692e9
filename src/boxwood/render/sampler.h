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

#include <array>
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

/// Both halves at once; the halves also change places.
constexpr std::uint64_t reverse_bits(std::uint64_t x) {
  x = (x << 32) | (x >> 32);
  x = ((x & 0x0000ffff0000ffffu) << 16) | ((x >> 16) & 0x0000ffff0000ffffu);
  x = ((x & 0x00ff00ff00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ff00ff00ffu);
  x = ((x & 0x0f0f0f0f0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0f0f0f0f0fu);
  x = ((x & 0x3333333333333333u) << 2) | ((x >> 2) & 0x3333333333333333u);
  return ((x & 0x5555555555555555u) << 1) | ((x >> 1) & 0x5555555555555555u);
}

/// What each value of each byte of an index, its bits reversed, adds to the second coordinate, its bits
/// reversed too. The direction numbers of that coordinate are the rows of Pascal's triangle modulo 2.
inline constexpr auto kSecondSobol = [] {
  std::array<std::array<std::uint32_t, 256>, 4> table{};
  std::uint32_t direction = 0x80000000u;
  for (unsigned bit = 31; bit < 32; --bit, direction ^= direction >> 1)
    for (unsigned value = 0; value < 256; ++value)
      if (value >> (bit % 8) & 1u) table[bit / 8][value] ^= reverse_bits(direction);
  return table;
}();

/// The numbers of one sample of one pixel, drawn in a fixed order.
class Sampler {
 public:
  Sampler(std::uint32_t pixel_index, std::uint32_t sample_index)
      : pixel_seed_(hash_bits(pixel_index, 0x5eed)), reversed_index_(reverse_bits(sample_index)) {}

  /// In [0, 1).
  float next_1d() { return next_2d().x; }

  /// Both in [0, 1).
  Vec2 next_2d() {
    const std::uint32_t seed = hash_bits(pixel_seed_, dimension_++);
    // Shuffle: which point of the sequence this sample takes.
    const std::uint32_t reversed = owen_scramble_reversed(reversed_index_, seed);
    // Its first coordinate is the index with its bits reversed,
    // so the reversed coordinate is the index itself.
    const std::uint32_t x = owen_scramble_reversed(reverse_bits(reversed), hash_bits(seed, 1));
    const std::uint32_t y = owen_scramble_reversed(second_sobol(reversed), hash_bits(seed, 2));
    const std::uint64_t both = reverse_bits(std::uint64_t{y} << 32 | x);
    return {to_unit(static_cast<std::uint32_t>(both >> 32)), to_unit(static_cast<std::uint32_t>(both))};
  }

 private:
  /// The second coordinate of the Sobol sequence; both are reversed.
  /// It is linear over bits, so each byte adds (xor) its own share.
  static constexpr std::uint32_t second_sobol(std::uint32_t reversed) {
    return kSecondSobol[0][reversed & 255] ^ kSecondSobol[1][(reversed >> 8) & 255] ^
           kSecondSobol[2][(reversed >> 16) & 255] ^ kSecondSobol[3][reversed >> 24];
  }
  static constexpr float to_unit(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

  std::uint32_t pixel_seed_, reversed_index_, dimension_ = 0;
};

}  // namespace boxwood::render
