// binned_sah.h: where would the surface area heuristic split, if it may look at a few places only?
//
// Cut the range of the centers into equal bins on each axis, collect the boxes that fall into each, and price
// the planes between the bins (bins.h): two passes over the primitives a level in place of a sort, and a
// tree that is nearly as good as the sweep's. Wald, "On Fast Construction of SAH-based Bounding Volume
// Hierarchies", IEEE RT 2007. Up to four primitives are split in every possible way instead.
#pragma once

#include "boxwood/build/bins.h"
#include "boxwood/build/morton_order.h"
#include "boxwood/build/top_down.h"

namespace boxwood {

/// Cost: n log n. A node of leaf_size primitives or fewer is a leaf when no split is cheaper; a larger one
/// never is, and where bins cannot tell its centers apart it is halved.
class BinnedSahSplitter {
 public:
  /// The primitives of a range, or groups of them, and room for as many: a range is split from one into the
  /// other, and its right half stays there.
  struct Share {
    std::span<Item> items;
    Item* room;
    bool are_groups;
    Reach box;
    Reach centers;  ///< Twice the centers lie about here.
  };

  BinnedSahSplitter(const Items& items, const BuildOptions& options, Executor& executor);
  Share root() const { return root_; }
  Step<Share> step(Range range, Plan plan, const Share& share);
  void write_leaf(Range range, const Share& share, std::span<PrimId> out) const;

 private:
  Step<Share> split_at_plane(Range range, const Share& share);
  Share take_apart(Range range, const Share& share) const;
  Step<Share> split_few(Range range, const Share& share) const;
  Step<Share> halve(Range range, const Share& share) const;
  /// Whether a range becomes two that cost `children_cost`; areas as in Scale.
  bool should_split(std::uint32_t count, float area, float children_cost) const {
    return count > leaf_size_ || cost_.split(area, children_cost) < cost_.leaf(area, count);
  }

  std::span<Item> items_;
  RawArray<Item> room_;
  MortonOrder order_;
  RawArray<Group> group_room_;
  Share root_;
  const std::uint32_t leaf_size_;
  const int max_bins_;
  const SahCost cost_;
  Executor& executor_;
  const BinKernels& kernels_ = bin_kernels();
};

}  // namespace boxwood
