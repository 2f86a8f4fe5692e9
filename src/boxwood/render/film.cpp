#include "boxwood/render/film.h"

#include <algorithm>
#include <cassert>

namespace boxwood::render {

TileSums::TileSums(std::size_t pixel_count, std::span<const int> group_sizes) : first_channel_{0} {
  for (const int size : group_sizes)
    first_channel_.push_back(first_channel_.back() + static_cast<std::size_t>(size));
  digits_.resize(pixel_count * first_channel_.back());
  counts_.resize(pixel_count * group_sizes.size());
  places_.resize(pixel_count * group_sizes.size());
  samples_.resize(pixel_count);
}

void TileSums::add(std::size_t pixel, std::size_t group, std::span<const float> values, int sign) {
  const std::size_t at = group_at(pixel, group);
  add_exactly(digits(pixel, group), places_[at], values, sign);
  counts_[at] += sign;
}

void TileSums::add(const TileSums& other) {
  assert(other.digits_.size() == digits_.size() && other.counts_.size() == counts_.size());
  const std::size_t groups = first_channel_.size() - 1;
  for (std::size_t pixel = 0; pixel < samples_.size(); ++pixel) {
    samples_[pixel] += other.samples_[pixel];
    for (std::size_t group = 0; group < groups; ++group) {
      const std::size_t at = group_at(pixel, group);
      add_exactly(digits(pixel, group), places_[at], other.digits(pixel, group), other.places_[at]);
      counts_[at] += other.counts_[at];
    }
  }
}

void TileSums::read(std::size_t pixel, std::size_t group, std::span<double> sums) const {
  const std::span<const Digits> found = digits(pixel, group);
  for (std::size_t c = 0; c < found.size(); ++c)
    sums[c] = value_of(found[c], places_[group_at(pixel, group)]);
}

void TileSums::to_words(std::span<std::uint32_t> words) const {
  assert(words.size() == word_count());
  const std::size_t groups = first_channel_.size() - 1;
  std::uint32_t* out = words.data();
  const auto put = [&out](std::uint64_t x) {
    *out++ = static_cast<std::uint32_t>(x);
    *out++ = static_cast<std::uint32_t>(x >> 32);
  };
  for (std::size_t pixel = 0; pixel < samples_.size(); ++pixel) {
    *out++ = samples_[pixel];
    for (std::size_t group = 0; group < groups; ++group) {
      *out++ = static_cast<std::uint32_t>(counts_[group_at(pixel, group)]);
      *out++ = places_[group_at(pixel, group)];
      for (const Digits& sum : digits(pixel, group)) {
        put(static_cast<std::uint64_t>(sum.upper));
        put(static_cast<std::uint64_t>(sum.lower));
      }
    }
  }
}

void TileSums::from_words(std::span<const std::uint32_t> words) {
  assert(words.size() == word_count());
  const std::size_t groups = first_channel_.size() - 1;
  const std::uint32_t* in = words.data();
  const auto take = [&in] {
    const std::uint64_t low = *in++, high = *in++;
    return static_cast<std::int64_t>(low | high << 32);
  };
  for (std::size_t pixel = 0; pixel < samples_.size(); ++pixel) {
    samples_[pixel] = *in++;
    for (std::size_t group = 0; group < groups; ++group) {
      counts_[group_at(pixel, group)] = static_cast<std::int32_t>(*in++);
      // Whatever the words were, nothing may be looked up outside its table.
      places_[group_at(pixel, group)] =
          static_cast<std::uint8_t>(std::min<std::uint32_t>(*in++, kHighestPlace));
      for (Digits& sum : digits(pixel, group)) {
        sum.upper = take();
        sum.lower = take();
      }
    }
  }
}

Film::Film(int width, int height, std::vector<int> group_sizes)
    : grid_{width, height}, group_sizes_(std::move(group_sizes)), locks_(grid_.size()) {
  tiles_.reserve(grid_.size());
  for (std::size_t tile = 0; tile < grid_.size(); ++tile) tiles_.push_back({empty_tile(tile)});
}

TileSums Film::empty_tile(std::size_t tile) const {
  return {grid_.area(tile).pixel_count(), group_sizes_};
}

bool Film::add(std::size_t tile, int unit, const TileSums& sums, const Effort& effort) {
  const std::lock_guard lock(locks_[tile]);
  const std::uint64_t bit = std::uint64_t{1} << unit;
  if (tiles_[tile].units & bit) return false;
  tiles_[tile].units |= bit;
  tiles_[tile].sums.add(sums);
  tiles_[tile].effort += effort;
  return true;
}

bool Film::has(std::size_t tile, int unit) const {
  const std::lock_guard lock(locks_[tile]);
  return (tiles_[tile].units >> unit & 1) != 0;
}

void Film::begin_round() {
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
    const std::lock_guard lock(locks_[tile]);
    tiles_[tile].units = 0;
  }
}

void Film::set(std::size_t tile, Tile held) {
  const std::lock_guard lock(locks_[tile]);
  tiles_[tile] = std::move(held);
}

}  // namespace boxwood::render
