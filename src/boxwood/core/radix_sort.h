// radix_sort.h: how are a million keys put in order?
//
// Least significant digit first: one stable counting sort a digit of 11 bits, from the lowest to the highest,
// after which the keys are sorted (Knuth, The Art of Computer Programming 3, section 5.2.5). Blocks of the
// input are counted and moved at the same time; each block knows from the counts of those before it where its
// own keys go (Zagha and Blelloch, "Radix Sort for Vector Multiprocessors", 1991). A digit that is the same
// in all keys is skipped.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "boxwood/core/parallel.h"

namespace boxwood {

/// Sorts `keys` in ascending order and moves `values` along. Stable, and so the same for any number of
/// threads. Throws std::invalid_argument when the spans differ in length. Cost: linear; memory: a copy of
/// both spans.
void radix_sort(std::span<std::uint32_t> keys, std::span<std::uint32_t> values, Executor& executor);
void radix_sort(std::span<std::uint64_t> keys, std::span<std::uint32_t> values, Executor& executor);

/// Sorts `keys` by their bits from `first_bit` on; what stands in the bits below moves along. Stable.
void radix_sort_from_bit(int first_bit, std::span<std::uint64_t> keys, Executor& executor);

/// A key that orders like the float: -inf < ... < -0 = +0 < ... < +inf. Not for NaN.
inline std::uint32_t sortable_bits(float f) {
  const auto bits = std::bit_cast<std::uint32_t>(f + 0.0f);  // -0 becomes +0
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

}  // namespace boxwood
