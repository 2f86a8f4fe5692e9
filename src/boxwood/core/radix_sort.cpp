#include "boxwood/core/radix_sort.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "boxwood/core/raw_array.h"

namespace boxwood {
namespace {

constexpr int kDigitBits = 11;  // three moves sort 30 bits
constexpr std::size_t kDigits = 1 << kDigitBits;
constexpr std::size_t kBlock = 1 << 16;  // large against the counters that each block costs

using Counts = std::array<std::size_t, kDigits>;

template <class Key>
std::size_t digit_of(Key key, int shift) {
  return static_cast<std::size_t>(key >> shift) & (kDigits - 1);
}

/// By the bits [first_bit, end_bit). With kMovesValues as many values as keys, else none.
template <bool kMovesValues, class Key>
void sort_by_digits(std::span<Key> keys, std::span<std::uint32_t> values, int first_bit, int end_bit,
                    Executor& executor) {
  const std::size_t n = keys.size(), blocks = (n + kBlock - 1) / kBlock;
  const RawArray<Key> other_keys(n);
  const RawArray<std::uint32_t> other_values(values.size());
  std::vector<Counts> counts(blocks);
  std::span<Key> from_keys = keys, to_keys{other_keys.data(), n};
  std::span<std::uint32_t> from_values = values, to_values{other_values.data(), values.size()};

  for (int shift = first_bit; shift < end_bit; shift += kDigitBits) {
    // Count the digits of each block.
    parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
      Counts& count = counts[block];
      count.fill(0);
      for (std::size_t i = block * kBlock; i < std::min(n, (block + 1) * kBlock); ++i)
        ++count[digit_of(from_keys[i], shift)];
    });

    // Turn counts into places: all smaller digits come first, then the same digit of the blocks before.
    std::size_t place = 0;
    bool is_same_everywhere = false;
    for (std::size_t digit = 0; digit < kDigits; ++digit) {
      const std::size_t first = place;
      for (Counts& count : counts) {
        const std::size_t here = count[digit];
        count[digit] = place;
        place += here;
      }
      is_same_everywhere |= place - first == n;
    }
    if (is_same_everywhere) continue;

    // Move the keys, each block in order: that is what makes the sort stable.
    parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
      Counts& next = counts[block];
      for (std::size_t i = block * kBlock; i < std::min(n, (block + 1) * kBlock); ++i) {
        const std::size_t to = next[digit_of(from_keys[i], shift)]++;
        to_keys[to] = from_keys[i];
        if constexpr (kMovesValues) to_values[to] = from_values[i];
      }
    });
    std::swap(from_keys, to_keys);
    std::swap(from_values, to_values);
  }

  // An odd number of moves leaves the result in the copy.
  if (from_keys.data() == keys.data()) return;
  parallel_for(executor, 0, n, kBlock, [&](std::size_t i) {
    keys[i] = from_keys[i];
    if constexpr (kMovesValues) values[i] = from_values[i];
  });
}

void check_sizes(std::size_t keys, std::size_t values) {
  if (keys != values)
    throw std::invalid_argument("radix_sort: " + std::to_string(keys) + " keys and " +
                                std::to_string(values) + " values, expected as many of both");
}

}  // namespace

void radix_sort(std::span<std::uint32_t> keys, std::span<std::uint32_t> values, Executor& executor) {
  check_sizes(keys.size(), values.size());
  sort_by_digits<true>(keys, values, 0, 32, executor);
}

void radix_sort(std::span<std::uint64_t> keys, std::span<std::uint32_t> values, Executor& executor) {
  check_sizes(keys.size(), values.size());
  sort_by_digits<true>(keys, values, 0, 64, executor);
}

void radix_sort_from_bit(int first_bit, std::span<std::uint64_t> keys, Executor& executor) {
  sort_by_digits<false>(keys, {}, first_bit, 64, executor);
}

}  // namespace boxwood
