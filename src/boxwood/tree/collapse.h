// collapse.h: how does a binary tree become a wide one?
//
// A wide node stands for a binary node and swallows some of the levels below it. Which ones is decided
// exactly: for each binary node, the least cost (surface area heuristic) of its subtree as at most 1, 2, ...
// W - 1 children of some wide node follows from those of its two sides, from the leaves up; from the root
// down the best choices are then read off. Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on
// GPUs Through Compressed Wide BVHs", HPG 2017, section 3.
#pragma once

#include "boxwood/core/parallel.h"
#include "boxwood/tree/bvh.h"
#include "boxwood/tree/wide.h"

namespace boxwood {

/// What the visits of a kernel cost, in any unit: measured (docs/performance.md).
struct WideCost {
  float node = 1.0f;   ///< One step over the children of a node.
  float block = 0.5f;  ///< One test of a block of kBlockWidth primitives.
  /// Subtrees of no more primitives may become leaves; at most kMaxLeafBlocks * kBlockWidth.
  std::uint32_t leaf_size = kMaxLeafBlocks * kBlockWidth;
};

/// The wide tree of least expected cost among those that keep the binary tree's boxes. Subtrees become leaves
/// where that is cheaper, so a binary tree with small leaves gives it the most to choose from. Primitives
/// with an empty box are left out. The result does not depend on the executor. Throws std::length_error when
/// the tree needs 2^28 nodes or blocks or more. Cost: linear.
template <int W>
WideBvh<W> collapse(const BvhView& bvh, Executor& executor, WideCost cost = {});

extern template WideBvh<4> collapse<4>(const BvhView&, Executor&, WideCost);
extern template WideBvh<8> collapse<8>(const BvhView&, Executor&, WideCost);
extern template WideBvh<16> collapse<16>(const BvhView&, Executor&, WideCost);

}  // namespace boxwood
