// box_tree.h: how do boxes of anything lie in memory for the kernels?
//
// As the nodes of a TriangleTree do, but that a leaf is one item, named by its number, in a box of its own:
// whoever asks knows what the item is. A scene keeps its placements so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "boxwood/core/memory_block.h"
#include "boxwood/tree/wide.h"

namespace boxwood::simd {

class BoxTree {
 public:
  /// What Kernels::visit_boxes gives the slabs of a ray: see TriangleTree::box_slack().
  static constexpr float kSlack = 1.5f;

  BoxTree() = default;
  /// boxes[i] is the box of primitive i of `wide`, whose leaves are taken apart. Throws std::length_error
  /// when 28 bits cannot address the nodes.
  template <int W>
  BoxTree(const WideBvh<W>& wide, std::span<const Box3> boxes);

  bool is_empty() const { return pool_.size() == 0; }
  /// Whether kernels may walk it: its boxes lie where no float overflows, and not too deep for their stack.
  bool is_ordinary() const { return is_ordinary_; }
  /// Where a walk begins: at the root node, or at the only item, which knows its own box.
  std::uint32_t first() const { return first_; }
  /// The most children that a walk ever leaves behind for later.
  int max_stack() const { return max_stack_; }
  int width() const { return width_; }
  const char* pool() const { return pool_.data(); }
  std::size_t size_bytes() const { return pool_.size(); }

  /// The low bits of a reference to a leaf, which is none of triangles; the item that it names.
  static constexpr std::uint32_t kItem = 3;
  static constexpr std::uint32_t item_of(std::uint32_t leaf) { return leaf >> 4; }

 private:
  MemoryBlock pool_;
  std::uint32_t first_ = 0;
  int width_ = 8, max_stack_ = 0;
  bool is_ordinary_ = true;
};

extern template BoxTree::BoxTree(const WideBvh<4>&, std::span<const Box3>);
extern template BoxTree::BoxTree(const WideBvh<8>&, std::span<const Box3>);
extern template BoxTree::BoxTree(const WideBvh<16>&, std::span<const Box3>);

}  // namespace boxwood::simd
