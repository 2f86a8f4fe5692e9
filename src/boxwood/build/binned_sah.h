// binned_sah.h: where would the surface area heuristic split, if it may look at a few places only?
//
// Cut the range of the centers into equal bins on each axis, collect the boxes that fall into each, and price
// the planes between the bins: two passes over the primitives a level in place of a sort, and a tree that is
// nearly as good as the sweep's. Wald, "On Fast Construction of SAH-based Bounding Volume Hierarchies", IEEE
// RT 2007.
#pragma once

#include "boxwood/build/cost.h"
#include "boxwood/build/top_down.h"

namespace boxwood {

/// Cost: n log n. A node of leaf_size primitives or fewer is a leaf when no split is cheaper; a larger one
/// never is, and where bins cannot tell its centers apart it is halved.
class BinnedSahSplitter {
 public:
  static constexpr int kMaxBins = 64;

  BinnedSahSplitter(std::vector<Item>& items, const BuildOptions& options, Executor& executor);
  Step step(Range range, Plan plan);
  void write_leaf(Range range, std::span<PrimId> out) const;

 private:
  std::span<Item> items_;
  std::vector<Item> scratch_;  // as long as items_, or empty where no range is large
  const std::uint32_t leaf_size_;
  const int max_bins_;
  const SahCost cost_;
  Executor& executor_;
};

}  // namespace boxwood
