// placed_trees.h: what do kernels walk where trees of triangles stand under transforms?
//
// A tree over the world boxes of placements (box_tree.h), whose items say how a ray comes into the object's
// space and which tree it meets there. Trees are shared: an object has one, however often it is placed.
#pragma once

#include <vector>

#include "boxwood/core/affine.h"
#include "boxwood/simd/box_tree.h"
#include "boxwood/simd/triangle_tree.h"

namespace boxwood::simd {

/// Two lines of the cache, which say all that a ray must know to go on.
struct alignas(64) PlacedTree {
  Affine3 object_from_world;
  Box3 world_box;            ///< The gate of what is placed (shape/gate.h).
  Box3 bounds;               ///< Those of the object, in its own space.
  const TriangleTree* tree;  ///< Null where the object has no triangles; must outlive this.
  const char* pool;          ///< The tree's; and
  float box_slack;           ///< so is this.
  std::uint32_t instance;    ///< The caller's name; equal t goes to the smaller one.
  std::uint32_t geometry;    ///< The caller's, and not looked at by kernels.
};
static_assert(sizeof(PlacedTree) == 128);

class PlacedTrees {
 public:
  PlacedTrees() = default;
  /// items[i] stands in the i-th box of `boxes`; all trees have one layout, and keys less than 2^32 - 1.
  PlacedTrees(BoxTree boxes, std::vector<PlacedTree> items);

  /// Whether there are no items at all; whether there are triangles below any.
  bool is_empty() const { return boxes_.is_empty(); }
  bool has_triangles() const { return has_triangles_; }
  /// Whether kernels may walk them: all trees are ordinary.
  bool is_ordinary() const { return is_ordinary_; }
  /// The most that a walk through both levels ever leaves behind for later.
  int max_stack() const { return max_stack_; }
  Layout layout() const { return layout_; }
  const BoxTree& boxes() const { return boxes_; }
  const std::vector<PlacedTree>& items() const { return items_; }
  std::size_t size_bytes() const { return boxes_.size_bytes() + items_.size() * sizeof(PlacedTree); }

 private:
  BoxTree boxes_;
  std::vector<PlacedTree> items_;
  bool is_ordinary_ = true, has_triangles_ = false;
  int max_stack_ = 0;
  Layout layout_ = Layout::full;
};

}  // namespace boxwood::simd
