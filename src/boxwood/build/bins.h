// bins.h: what fell into the bins, and where would one cut between them?
//
// The range of the centers is cut into equal bins on each axis; a bin keeps how many primitives have their
// center in it, and the union of their boxes. Wald, "On Fast Construction of SAH-based Bounding Volume
// Hierarchies", IEEE RT 2007.
//
// Nearly all of a build's time goes into these loops, so they exist twice on x86-64: for every CPU, and for
// those with AVX2, where a box is one register. Both do the same operations in the same order.
#pragma once

#include "boxwood/build/cost.h"
#include "boxwood/build/item.h"

namespace boxwood {

inline constexpr int kMaxBins = 64;

/// Which bin a center falls into: monotonic in the center, so that bins are slabs in order. Centers outside
/// the range that was given fall into the first or the last bin, so that range may be a guess.
struct Binning {
  Lanes lower, scale, last;
  int bins;

  /// `centers` is a range of *twice* the centers.
  Binning(const Reach& centers, int bin_count)
      : lower(Lanes::all(0) - centers.minus_lower), last(Lanes::all(float(bin_count - 1))), bins(bin_count) {
    // Where the scale overflows, or there is nothing to tell apart, everything falls into bin 0.
    float s[4] = {0, 0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      const float extent = centers.upper.v[k] + centers.minus_lower.v[k];
      if (extent > float(bins) * 0x1p-120f && extent < kInfinity) s[k] = float(bins) / extent;
    }
    scale = {Lanes::Register{s[0], s[1], s[2], 0}};
  }
  /// Where `bin` begins on `axis`.
  float border(int axis, int bin) const { return lower.v[axis] + float(bin) / scale.v[axis]; }
};

/// A bin on each axis, many times. `count` has a fourth lane that stays 0.
struct alignas(32) Histogram {
  explicit Histogram(int bin_count);

  struct alignas(32) Slab {
    Lanes minus_lower, upper;
  };
  int bins;
  Slab slab[kMaxBins][3];
  std::int32_t count[kMaxBins][4];
};

/// A plane between two bins, and what lies on both sides of it.
struct Cut {
  int axis = -1;            ///< -1: no plane has something on both sides, or areas are beyond all floats.
  int bin = 0;              ///< The first one on the right.
  float children_cost = 0;  ///< As in cost.h, with areas as Scale has them.
  std::uint32_t left_count = 0;
  Reach left, right;
};

/// The loops, for the CPU that the program runs on.
struct BinKernels {
  /// Extends `all` by the items.
  void (*bound)(Bounds& all, std::span<const Item> items);
  /// Drops the items into their bins; a group (morton_order.h) counts for all its members.
  void (*fill)(Histogram& histogram, const Binning& binning, std::span<const Item> items, bool are_groups);
  /// Adds one histogram to another.
  void (*merge)(Histogram& histogram, const Histogram& other);
  /// The cheapest of all planes; `box` holds all that was added, `total` primitives.
  Cut (*best_cut)(const Histogram& histogram, const Reach& box, std::uint32_t total, const SahCost& cost);
  /// Parts `items` by the plane before `bin` into those on the left, which stay, and the others, which go to
  /// `room`; both keep their order. Returns how many go left.
  std::size_t (*part)(std::span<Item> items, Item* room, const Binning& binning, int axis, int bin);
};
const BinKernels& bin_kernels();

/// Whether an item's bin on `axis` is before `bin`: what part() asks. (NaN, where a center is beyond all
/// floats, falls into bin 0.)
inline bool is_before(const Item& item, const Binning& binning, int axis, int bin) {
  const float center = item.upper[axis] - item.minus_lower[axis];
  return !((center - binning.lower.v[axis]) * binning.scale.v[axis] >= float(bin));
}

}  // namespace boxwood
