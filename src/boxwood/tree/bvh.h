// bvh.h: how does a binary tree of boxes lie in memory?
//
// One array of 32-byte nodes, two to a cache line, and one array with the order of the primitives. Data only:
// builders make it, queries read it, validate (validate.h) says the first invariant that does not hold:
//
//  1. nodes is empty when there are no primitives; otherwise node 0 is the root.
//  2. An interior node has count == 0 and its children at first_index and first_index + 1,
//     after itself in the array.
//  3. A leaf has count > 0 and owns prim_ids[first_index, first_index + count).
//  4. Each node but the root has one parent; each primitive stands in exactly one leaf.
//  5. The box of a node holds the boxes of its children; the box of a leaf holds the boxes of its primitives.
//  6. No node lies deeper than kMaxDepth, so that a query can keep its stack in a fixed array.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "boxwood/core/box.h"
#include "boxwood/core/id.h"

namespace boxwood {

/// The root has depth 0. Builders fall back to halving, which adds at most 32, well before.
inline constexpr int kMaxDepth = 96;

struct BvhNode {
  Box3 box;
  std::uint32_t first_index = 0;  ///< Of the left child, or of the first primitive.
  std::uint32_t count = 0;        ///< Primitives of a leaf; 0 for an interior node.

  bool is_leaf() const { return count > 0; }
  friend bool operator==(const BvhNode&, const BvhNode&) = default;
};
static_assert(sizeof(BvhNode) == 32);

struct Bvh {
  std::vector<BvhNode> nodes;
  std::vector<PrimId> prim_ids;  ///< Position in leaf order -> the user's number of the primitive.

  bool is_empty() const { return nodes.empty(); }
  /// Of everything in the tree; empty for an empty tree.
  Box3 bounds() const { return nodes.empty() ? Box3{} : nodes[0].box; }
  std::size_t size_bytes() const { return nodes.size() * sizeof(BvhNode) + prim_ids.size() * sizeof(PrimId); }
  friend bool operator==(const Bvh&, const Bvh&) = default;
};

/// The same, wherever it lies; its invariants 2 and 6 are those of whoever made it.
struct BvhView {
  std::span<const BvhNode> nodes;
  std::span<const PrimId> prim_ids;

  BvhView(std::span<const BvhNode> all_nodes, std::span<const PrimId> ids)
      : nodes(all_nodes), prim_ids(ids) {}
  BvhView(const Bvh& bvh) : nodes(bvh.nodes), prim_ids(bvh.prim_ids) {}
  bool is_empty() const { return nodes.empty(); }
  Box3 bounds() const { return nodes.empty() ? Box3{} : nodes[0].box; }
};

}  // namespace boxwood
