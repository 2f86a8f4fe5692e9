// triangle_tree.h: what do the kernels walk?
//
// A wide tree (tree/wide.h) and its triangles, in one pool of memory: first the nodes, then the blocks. A
// reference counts in units of 32 bytes, so the address of what it names is two shifts away, and a reference
// to a node is half of its offset. A block holds four triangles coordinate by coordinate, so that one vector
// is the same coordinate of all four.
#pragma once

#include <functional>
#include <span>

#include "boxwood/core/parallel.h"
#include "boxwood/shape/gate.h"
#include "boxwood/shape/triangle.h"
#include "boxwood/simd/huge_buffer.h"
#include "boxwood/tree/wide.h"

namespace boxwood::simd {

struct alignas(32) TriangleBlock {
  float v[3][3][kBlockWidth];      ///< Vertex, axis, lane.
  std::uint32_t key[kBlockWidth];  ///< The caller's name of the triangle; equal t goes to the smaller key.

  Triangle triangle(std::uint32_t lane) const {
    const auto at = [&](int k) { return Vec3{v[k][0][lane], v[k][1][lane], v[k][2][lane]}; };
    return {at(0), at(1), at(2)};
  }
};
static_assert(sizeof(TriangleBlock) == 160);

/// A leaf test cannot overflow where no coordinate, and none less that of a ray's origin, is larger.
inline constexpr float kLargestReach = 0x1p36f;

class TriangleTree {
 public:
  static constexpr std::size_t kUnit = 32;

  TriangleTree() = default;

  /// Fetches the triangles of a block: writes those of kBlockWidth slots. Called by several threads at once.
  using Fetch = std::function<void(const PrimId* slots, Triangle* triangles)>;

  /// Packs `wide`; its slots pick the triangles, and are their keys. The executor shows in the time only.
  /// Throws std::length_error when the pool would be larger than 8 GB, or a walk needs more room than
  /// kMaxWideStack.
  template <int W>
  TriangleTree(const WideBvh<W>& wide, const Fetch& fetch, Executor& executor);
  /// The same for triangles in an array. No keys: each triangle's is its number.
  template <int W>
  TriangleTree(const WideBvh<W>& wide, std::span<const Triangle> triangles,
               std::span<const std::uint32_t> keys, Executor& executor);

  bool is_empty() const { return pool_.size() == 0; }
  /// Whether no float of a kernel can overflow among these triangles and ordinary rays.
  bool is_ordinary() const { return is_ordinary_; }
  /// Whether a triangle may stand in several leaves.
  bool has_parts() const { return has_parts_; }
  /// How many times the slack of a ray's slabs (core/prepared_ray.h) a kernel must give the boxes. Half of it
  /// once more is more than fusing multiply and add can change; for boxes of parts see shape/gate.h.
  float box_slack() const { return has_parts_ ? kPartSlack : 1.5f; }
  /// The most children that a walk ever leaves behind for later.
  int max_stack() const { return max_stack_; }
  int width() const { return width_; }
  const Box3& box() const { return box_; }
  std::size_t node_count() const { return node_count_; }
  std::size_t block_count() const { return block_count_; }
  std::size_t size_bytes() const { return pool_.size(); }
  std::size_t node_bytes() const { return blocks_at_; }

  /// The tree as it was before it was packed, with keys for primitives: for metrics and validate. Safe on any
  /// bytes: a reference that leads nowhere becomes one out of range. Precondition: W = width().
  template <int W>
  WideBvh<W> unpack() const;

  const char* pool() const { return pool_.data(); }
  /// The bytes behind a reference of the pool.
  const char* at(ChildRef ref) const { return pool_.data() + std::size_t(ref.index()) * kUnit; }
  /// The blocks of a leaf.
  std::span<const TriangleBlock> blocks_of(ChildRef leaf) const {
    return {reinterpret_cast<const TriangleBlock*>(at(leaf)), leaf.blocks()};
  }
  /// The block that a hit names.
  const TriangleBlock& block_at(std::uint32_t units) const {
    return *reinterpret_cast<const TriangleBlock*>(pool_.data() + std::size_t(units) * kUnit);
  }
  /// All blocks, one behind the other.
  std::span<const TriangleBlock> blocks() const {
    return {reinterpret_cast<const TriangleBlock*>(pool_.data() + blocks_at_), block_count_};
  }
  /// A node, or all nodes, of a tree with W = width() children; references count in units.
  template <int W>
  const WideNode<W>& node_at(ChildRef node) const {
    return *reinterpret_cast<const WideNode<W>*>(at(node));
  }
  template <int W>
  std::span<const WideNode<W>> nodes() const {
    return {reinterpret_cast<const WideNode<W>*>(pool_.data()), node_count_};
  }

 private:
  HugeBuffer pool_;
  std::size_t blocks_at_ = 0, node_count_ = 0, block_count_ = 0;
  int width_ = 8, max_stack_ = 0;
  bool is_ordinary_ = true, has_parts_ = false;
  Box3 box_;
};

extern template TriangleTree::TriangleTree(const WideBvh<4>&, const Fetch&, Executor&);
extern template TriangleTree::TriangleTree(const WideBvh<8>&, const Fetch&, Executor&);
extern template TriangleTree::TriangleTree(const WideBvh<4>&, std::span<const Triangle>,
                                           std::span<const std::uint32_t>, Executor&);
extern template TriangleTree::TriangleTree(const WideBvh<8>&, std::span<const Triangle>,
                                           std::span<const std::uint32_t>, Executor&);
extern template WideBvh<4> TriangleTree::unpack() const;
extern template WideBvh<8> TriangleTree::unpack() const;

}  // namespace boxwood::simd
