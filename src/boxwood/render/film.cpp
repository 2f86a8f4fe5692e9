#include "boxwood/render/film.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace boxwood::render {
namespace {

/// Copies the bytes of `from` to `words`, and moves on to the next free word.
template <class T>
void put(const std::vector<T>& from, std::span<std::uint32_t>& words) {
  const std::size_t used = (from.size() * sizeof(T) + 3) / 4;
  words[used - 1] = 0;  // its last bytes may not be used
  std::memcpy(words.data(), from.data(), from.size() * sizeof(T));
  words = words.subspan(used);
}

template <class T>
void take(std::vector<T>& to, std::span<const std::uint32_t>& words) {
  std::memcpy(static_cast<void*>(to.data()), words.data(), to.size() * sizeof(T));
  words = words.subspan((to.size() * sizeof(T) + 3) / 4);
}

}  // namespace

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

std::size_t TileSums::word_count() const {
  return digits_.size() * sizeof(Digits) / 4 + counts_.size() + (places_.size() + 3) / 4 + samples_.size();
}

void TileSums::to_words(std::span<std::uint32_t> words) const {
  put(digits_, words);
  put(counts_, words);
  put(places_, words);
  put(samples_, words);
}

void TileSums::from_words(std::span<const std::uint32_t> words) {
  take(digits_, words);
  take(counts_, words);
  take(places_, words);
  take(samples_, words);
  // Whatever the words were, nothing may be looked up outside its table.
  for (std::uint8_t& place : places_) place = std::min<std::uint8_t>(place, kHighestPlace);
}

Film::Film(int width, int height, std::vector<int> group_sizes)
    : grid_{width, height}, group_sizes_(std::move(group_sizes)), locks_(grid_.size()) {
  tiles_.reserve(grid_.size());
  for (std::size_t tile = 0; tile < grid_.size(); ++tile) tiles_.push_back({empty_tile(tile)});
}

TileSums Film::empty_tile(std::size_t tile) const {
  return {grid_.area(tile).pixel_count(), group_sizes_};
}

bool Film::add(std::size_t tile, int unit, const TileSums& sums) {
  const std::lock_guard lock(locks_[tile]);
  const std::uint64_t bit = std::uint64_t{1} << unit;
  if (tiles_[tile].units & bit) return false;
  tiles_[tile].units |= bit;
  tiles_[tile].sums.add(sums);
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

void Film::set(std::size_t tile, TileSums sums, std::uint64_t units) {
  const std::lock_guard lock(locks_[tile]);
  tiles_[tile] = {std::move(sums), units};
}

}  // namespace boxwood::render
