// film.h: what has each pixel gathered so far?
//
// Exact sums (exact_sum.h) and counts, in tiles. Adding is associative to the last bit: whoever renders a
// share of the samples of a tile, in whichever order, the film holds the same in the end. So threads, shards,
// other machines and renders that were interrupted all make one picture. Tiles are added and read under a
// lock of their own: any thread may look at the film while others fill it.
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "boxwood/render/exact_sum.h"
#include "boxwood/scene/image.h"

namespace boxwood::render {

inline constexpr int kTileSide = 16;        ///< Pixels; tiles at the right and lower edge may be smaller.
inline constexpr int kMaxMainChannels = 3;  ///< Of what the picture itself shows.

/// The pixels of a tile: x0 <= x < x1, y0 <= y < y1.
struct TileArea {
  int x0, y0, x1, y1;
  std::size_t pixel_count() const { return std::size_t(x1 - x0) * std::size_t(y1 - y0); }
};

/// How a picture is cut into tiles, which are numbered row by row.
struct TileGrid {
  int width, height;

  int across() const { return (width + kTileSide - 1) / kTileSide; }
  int down() const { return (height + kTileSide - 1) / kTileSide; }
  std::size_t size() const { return std::size_t(across()) * std::size_t(down()); }
  TileArea area(std::size_t tile) const {
    const int x = static_cast<int>(tile) % across() * kTileSide;
    const int y = static_cast<int>(tile) / across() * kTileSide;
    const auto end = [](int start, int side) { return start + kTileSide < side ? start + kTileSide : side; };
    return {x, y, end(x, width), end(y, height)};
  }
};

/// The sums of the pixels of one tile, row by row. Each pixel has groups of channels (light, a normal, ...)
/// that are counted apart, since a sample may have no depth and yet a color.
class TileSums {
 public:
  /// `group_sizes`: the channels of each group.
  TileSums(std::size_t pixel_count, std::span<const int> group_sizes);

  /// Adds `values` to group `group` of `pixel`, times `sign` (1 or -1). Values must be finite.
  void add(std::size_t pixel, std::size_t group, std::span<const float> values, int sign);
  /// One more sample of this pixel, whatever its groups got.
  void count_sample(std::size_t pixel) { ++samples_[pixel]; }
  /// Adds what `other`, of the same shape, has gathered.
  void add(const TileSums& other);

  std::size_t pixel_count() const { return samples_.size(); }
  int channels(std::size_t group) const {
    return static_cast<int>(first_channel_[group + 1] - first_channel_[group]);
  }
  /// The sum of the group's values; as many as it has channels.
  void read(std::size_t pixel, std::size_t group, std::span<double> sums) const;
  /// How many samples the group got, those with negative sign counting -1.
  std::int32_t count(std::size_t pixel, std::size_t group) const { return counts_[group_at(pixel, group)]; }
  std::uint32_t samples(std::size_t pixel) const { return samples_[pixel]; }

  /// As plain words, pixel after pixel, for files and other machines; and back.
  std::size_t words_per_pixel() const {
    return 1 + 2 * (first_channel_.size() - 1) + sizeof(Digits) / 4 * first_channel_.back();
  }
  std::size_t word_count() const { return samples_.size() * words_per_pixel(); }
  void to_words(std::span<std::uint32_t> words) const;
  void from_words(std::span<const std::uint32_t> words);

  friend bool operator==(const TileSums&, const TileSums&) = default;

 private:
  std::size_t group_at(std::size_t pixel, std::size_t group) const {
    return pixel * (first_channel_.size() - 1) + group;
  }
  std::span<Digits> digits(std::size_t pixel, std::size_t group) {
    return std::span(digits_).subspan(pixel * first_channel_.back() + first_channel_[group],
                                      first_channel_[group + 1] - first_channel_[group]);
  }
  std::span<const Digits> digits(std::size_t pixel, std::size_t group) const {
    return const_cast<TileSums*>(this)->digits(pixel, group);
  }

  std::vector<std::size_t> first_channel_;  // of each group; and past the last
  std::vector<Digits> digits_;              // pixel x channel
  std::vector<std::int32_t> counts_;        // pixel x group
  std::vector<std::uint8_t> places_;        // pixel x group: the upper place of its digits
  std::vector<std::uint32_t> samples_;      // pixel
};

/// What was done for a tile's sums.
struct Effort {
  std::uint64_t rays = 0;     ///< Traced.
  std::uint64_t samples = 0;  ///< Taken, of all its pixels together;
  std::uint64_t dropped = 0;  ///< of which so many were not finite, and left out.

  void operator+=(const Effort& other) {
    rays += other.rays;
    samples += other.samples;
    dropped += other.dropped;
  }
  friend bool operator==(const Effort&, const Effort&) = default;
};

/// All tiles, and which units of the present round (rounds.h) each of them holds.
class Film {
 public:
  Film(int width, int height, std::vector<int> group_sizes);

  const TileGrid& grid() const { return grid_; }
  std::span<const int> group_sizes() const { return group_sizes_; }
  /// A tile without samples, to be filled and then added.
  TileSums empty_tile(std::size_t tile) const;

  struct Tile {
    TileSums sums;
    Effort effort = {};
    std::uint64_t units = 0;  ///< Bit i stands for unit i of the round.
  };

  /// Adds what unit `unit` (0 to 63) of the round brought to the tile. False, and nothing happens, when the
  /// film holds that unit already.
  bool add(std::size_t tile, int unit, const TileSums& sums, const Effort& effort = {});
  /// Whether the tile holds that unit.
  bool has(std::size_t tile, int unit) const;
  /// Forgets which units there were: a new round begins.
  void begin_round();

  /// Calls look(const Tile&) while nobody adds to the tile.
  template <class Look>
  auto with_tile(std::size_t tile, const Look& look) const {
    const std::lock_guard lock(locks_[tile]);
    return look(tiles_[tile]);
  }
  /// Replaces what the tile holds.
  void set(std::size_t tile, Tile held);

 private:
  TileGrid grid_;
  std::vector<int> group_sizes_;
  std::vector<Tile> tiles_;
  mutable std::vector<std::mutex> locks_;
};

}  // namespace boxwood::render
