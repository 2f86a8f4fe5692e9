// sweep_sah.h: where would the surface area heuristic split, if it may look everywhere?
//
// The primitives are sorted by center once on each axis. A node sweeps its part of each order twice: from the
// right, to note the area of all that follows, and from the left, to price every split into "the first i" and
// "the rest". The other two orders are then parted to match, which keeps them sorted: n log n in all, as Wald
// and Havran showed for kd-trees ("On Building Fast kd-Trees for Ray Tracing, and on Doing That in O(N log
// N)", IEEE RT 2006).
#pragma once

#include <array>

#include "boxwood/build/cost.h"
#include "boxwood/build/top_down.h"

namespace boxwood {

/// The same rules for leaves as BinnedSahSplitter; coincident primitives need no rule of their own, since any
/// order can be split anywhere.
class SweepSahSplitter {
 public:
  SweepSahSplitter(std::span<Item> items, const BuildOptions& options, Executor& executor);
  using Share = NoShare;
  NoShare root() const { return {}; }
  Step<NoShare> step(Range range, Plan plan, NoShare);
  void write_leaf(Range range, NoShare, std::span<PrimId> out) const;

 private:
  Split find_best_split(Range range, int axis);
  void part(Range range, int axis, std::uint32_t middle);

  std::span<const Item> items_;
  const std::uint32_t leaf_size_;
  const SahCost cost_;
  Executor& executor_;
  std::array<std::vector<std::uint32_t>, 3> order_;  // indices of items_, by center along each axis
  std::array<std::vector<double>, 3> right_area_;    // of a position and all behind it in its range
  std::array<std::vector<std::uint32_t>, 3> scratch_;
  std::vector<std::uint8_t> goes_left_;  // by index in items_
};

}  // namespace boxwood
