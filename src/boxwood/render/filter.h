// filter.h: how much does light beside a pixel count for it?
//
// Samples are spread by the filter instead of being weighed by it, so each belongs to one pixel only and the
// film needs no neighbours (Ernst, Stamminger and Greiner, "Filter Importance Sampling", 2006). Where a
// filter is negative, samples are spread by its magnitude and count with sign -1.
//
// Signs are not left to chance: a pixel with one sample of each sign would have no mean, and one with two
// against three hardly any. Negative samples come one at a time, evenly among the others, in the share that
// is theirs. So at any time nearly the right part of them has come, and none before there is enough to
// subtract from.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "boxwood/core/vec.h"

namespace boxwood::render {

enum class Filter {
  box,              ///< The pixel itself: radius 1/2.
  tent,             ///< Falls off linearly: radius 1.
  gaussian,         ///< Standard deviation 1/2, lowered to end at 0: radius 3/2.
  mitchell,         ///< Mitchell and Netravali, B = C = 1/3, sharp, with negative lobes: radius 2.
  blackman_harris,  ///< The minimum 4-term window: radius 3/2.
};

/// Where a sample goes, as seen from the center of its pixel, and the sign with which it counts there.
struct FilterSample {
  Vec2 offset;
  int sign = 1;
};

/// Draws from one filter.
class FilterSampler {
 public:
  explicit FilterSampler(Filter filter);
  /// Of the `index`-th sample of a pixel; `u` in the unit square. Well spread points stay well spread.
  FilterSample sample(Vec2 u, std::uint32_t index) const;

 private:
  static constexpr int kCells = 256;
  float along_axis(float u) const;
  float along_axis(float u, bool is_negative) const;

  Filter filter_;
  std::array<float, kCells + 1> share_{};  // of the magnitude's integral that lies below the edge of a cell
  float radius_;
  float negative_ = 0;  // the share of the magnitude at one end of an axis, where the filter is negative
};

/// The filter in one dimension, up to a factor; 0 beyond its radius.
double filter_value(Filter filter, double x);
float filter_radius(Filter filter);

/// "box", "tent", "gaussian", "mitchell", "blackman-harris"; and back. Throws std::invalid_argument for a
/// name that is not one of them.
std::string_view filter_name(Filter filter);
Filter filter_from_name(std::string_view name);

}  // namespace boxwood::render
