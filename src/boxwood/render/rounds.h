// rounds.h: in which order do a picture's samples come?
//
// In rounds that all pixels take together, so that a picture is whole, if noisy, from the first round on, and
// decisions between rounds rest on the same samples whoever made them. A round is cut into units, a few
// samples of each pixel of one tile, which threads and machines share out.
#pragma once

#include <algorithm>
#include <cstdint>

namespace boxwood::render {

inline constexpr int kUnitSamples = 16;  ///< Of each pixel; keeps a unit well below a second.
inline constexpr int kMaxRound = 1024;   ///< Samples of each pixel; 64 units, one bit each.

/// A share of the work: samples [first, first + count) of each pixel of a tile.
struct Unit {
  std::uint32_t tile;
  std::int32_t first, count;
};

/// The samples of each pixel that a round takes: [begin, end).
struct Round {
  int begin = 0, end = 0;

  int unit_count() const { return (end - begin + kUnitSamples - 1) / kUnitSamples; }
  Unit unit(std::uint32_t tile, int index) const {
    const int first = begin + index * kUnitSamples;
    return {tile, first, std::min(kUnitSamples, end - first)};
  }
  friend bool operator==(const Round&, const Round&) = default;
};

/// The round after `last` of the samples [first, end): 1, 1, 2, 4, 8 of them, then 16, and later an eighth of
/// all before, in whole units. Empty when none are left. `last` starts as {first, first}.
inline Round next_round(const Round& last, int first, int end) {
  const int done = last.end - first;
  int count = done < kUnitSamples ? std::max(done, 1) : std::max(done / 8 / kUnitSamples, 1) * kUnitSamples;
  count = std::min({count, kMaxRound, end - last.end});
  return {last.end, last.end + count};
}

}  // namespace boxwood::render
