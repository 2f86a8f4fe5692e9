// longest_axis.h: what is the simplest way to split a node?
//
// Cut its box in half across its longest axis: primitives with their center on the left of the cut go left.
// Easy to follow and cheap to decide, but blind to where the primitives are. Rules: a node at max_depth or of
// leaf_size primitives or fewer is a leaf, and so is a node all of whose centers lie on one side, however
// many they are.
#pragma once

#include "boxwood/build/top_down.h"

namespace boxwood {

/// Cost: a sort of the range for each node, so n log^2 n in all.
class LongestAxisSplitter {
 public:
  LongestAxisSplitter(std::span<Item> items, const BuildOptions& options);
  using Share = NoShare;
  NoShare root() const { return {}; }
  Step<NoShare> step(Range range, Plan plan, NoShare);
  void write_leaf(Range range, NoShare, std::span<PrimId> out) const;

 private:
  std::span<Item> items_;
  const std::uint32_t leaf_size_;
};

}  // namespace boxwood
