// wide.h: how does a tree with four, eight or sixteen children a node lie in memory?
//
// A node holds rows of planes, so that one vector is the same plane of all children, and one reference for
// each child. Sixteen children take 448 bytes, seven cache lines; eight take 256, four 128. Leaves are runs
// of blocks of kBlockWidth primitives, which a kernel tests together; a block that is not full repeats its
// first primitive. Data only: collapse (collapse.h) makes it from a binary tree, validate says the first
// broken invariant:
//
//  1. nodes is empty when there are no primitives; otherwise node 0 is the root.
//  2. A child is an interior node behind its parent in the array, a run of 1 to kMaxLeafBlocks blocks, or
//  empty.
//  3. An empty child has the empty box, so that no ray enters it.
//  4. The box of a child holds the boxes below it; each block belongs to one leaf.
//  5. Each primitive with a box that is not empty stands in one block, inside the box of its leaf; in a tree
//     with spatial splits (has_parts) it may stand in several leaves, whose boxes together reach from end to
//     end of it.
//  6. No node lies deeper than kMaxWideDepth, so that a query can keep its stack in a fixed array.
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "boxwood/core/id.h"
#include "boxwood/tree/bvh.h"

namespace boxwood {

inline constexpr int kBlockWidth = 4;     ///< Primitives of a block.
inline constexpr int kMaxLeafBlocks = 3;  ///< Blocks of a leaf.

/// A binary leaf at kMaxDepth may hold any number of primitives, fewer than 2^32 = 4^16; dealt out to four
/// children or more at each level, they need at most 16 further levels.
inline constexpr int kMaxWideDepth = kMaxDepth + 16;
/// The most children that a walk can have left for later: at each level all but the one that it goes to, and
/// at the last all.
template <int W>
inline constexpr int kMaxWideStack = kMaxWideDepth*(W - 1) + W;

/// Where a child leads: 28 bits of index, two for the number of blocks, and two that say what it is: 0 a
/// node, 1 a leaf (without blocks: an empty child). Kernels use the other two values for themselves.
struct ChildRef {
  std::uint32_t bits = 1;

  static constexpr ChildRef node(std::uint32_t node_index) { return {node_index << 4}; }
  static constexpr ChildRef leaf(std::uint32_t block_index, std::uint32_t blocks) {
    return {block_index << 4 | blocks << 2 | 1};
  }
  constexpr bool is_leaf() const { return bits & 1; }
  constexpr bool is_empty() const { return (bits & 15) == 1; }
  constexpr std::uint32_t index() const { return bits >> 4; }
  constexpr std::uint32_t blocks() const { return bits >> 2 & 3; }
  friend constexpr bool operator==(const ChildRef&, const ChildRef&) = default;
};

template <int W>
struct alignas(64) WideNode {
  float planes[3][2][W];  ///< Axis; lower, upper; child.
  ChildRef children[W];

  /// All children empty.
  WideNode() {
    for (int k = 0; k < 3; ++k) {  // row by row: every child with Box3{} and ChildRef{}
      std::fill_n(planes[k][0], W, Box3{}.lower[k]);
      std::fill_n(planes[k][1], W, Box3{}.upper[k]);
    }
  }
  Box3 box(int child) const {
    Box3 box;
    for (int k = 0; k < 3; ++k) {
      box.lower[k] = planes[k][0][child];
      box.upper[k] = planes[k][1][child];
    }
    return box;
  }
  void set(int child, const Box3& box, ChildRef ref) {
    for (int k = 0; k < 3; ++k) {
      planes[k][0][child] = box.lower[k];
      planes[k][1][child] = box.upper[k];
    }
    children[child] = ref;
  }
};
static_assert(sizeof(WideNode<16>) == 448 && sizeof(WideNode<8>) == 256 && sizeof(WideNode<4>) == 128);

/// Whether a slot of a block, or the key of a lane, only fills the block.
template <class T>
constexpr bool is_padding(const T* block, int lane) {
  return lane > 0 && block[lane] == block[0];
}

template <int W>
struct WideBvh {
  std::vector<WideNode<W>> nodes;
  std::vector<PrimId> slots;  ///< kBlockWidth for each block.
  Box3 box;
  bool has_parts = false;  ///< Whether a primitive may stand in several leaves; queries must know.
  float cost = 0;          ///< What the collapse made least: about sah_cost(*this), 0 where nobody knows.

  bool is_empty() const { return nodes.empty(); }
  std::size_t block_count() const { return slots.size() / kBlockWidth; }
  std::size_t size_bytes() const {
    return nodes.size() * sizeof(WideNode<W>) + slots.size() * sizeof(PrimId);
  }
};

/// Calls f with the number of children of a node as a constant of the program, W in
/// std::integral_constant<int, W>.
template <class F>
decltype(auto) with_width(int width, const F& f) {
  if (width == 4) return f(std::integral_constant<int, 4>());
  if (width == 8) return f(std::integral_constant<int, 8>());
  return f(std::integral_constant<int, 16>());
}

}  // namespace boxwood
