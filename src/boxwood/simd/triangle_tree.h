// triangle_tree.h: what do the kernels walk?
//
// A wide tree (tree/wide.h) and its triangles, in one pool of memory: first the nodes, then the blocks. A
// large pool is aligned to a huge page and backed by such, because a walk jumps about and would miss the TLB
// at every step. A reference counts in units of 32 bytes, so the address of what it names is two shifts away,
// and a reference to a node is half of its offset. There are two layouts. In full, a block holds four
// triangles coordinate by coordinate, so that one vector is the same coordinate of all four. The compact one
// takes half the memory: nodes are quantized (tree/quantized.h), and a block says where its vertices are, in
// the meshes that a scene keeps anyway.
#pragma once

#include <functional>
#include <span>

#include "boxwood/core/memory_block.h"
#include "boxwood/core/parallel.h"
#include "boxwood/shape/gate.h"
#include "boxwood/shape/triangle.h"
#include "boxwood/tree/quantized.h"

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

enum class Layout { full, compact };

/// Where a triangle's corners are.
struct Corners {
  const Vec3* vertices;
  std::uint32_t index[3];

  Triangle triangle() const { return {vertices[index[0]], vertices[index[1]], vertices[index[2]]}; }
};

struct alignas(32) CompactBlock {
  const Vec3* vertices[kBlockWidth];
  std::uint32_t index[3][kBlockWidth];  ///< Corner, lane.
  std::uint32_t key[kBlockWidth];

  Triangle triangle(std::uint32_t lane) const {
    return Corners{vertices[lane], {index[0][lane], index[1][lane], index[2][lane]}}.triangle();
  }
};
static_assert(sizeof(CompactBlock) == 96);

class TriangleTree {
 public:
  static constexpr std::size_t kUnit = 32;

  TriangleTree() = default;

  /// Tells the corners of at most kMaxFetch slots. Called by several threads at once.
  static constexpr std::size_t kMaxFetch = 128;
  using Fetch = std::function<void(std::span<const PrimId> slots, Corners* corners)>;

  /// Packs `wide`; its slots pick the triangles, and are their keys. A compact tree needs the vertices as
  /// long as it lives. The executor shows in the time only. Throws std::length_error when the pool would be
  /// larger than 8 GB, or a node lies deeper than kMaxWideDepth (wide.h).
  template <int W>
  TriangleTree(const WideBvh<W>& wide, const Fetch& fetch, Layout layout, Executor& executor);
  /// The same for triangles in an array. No keys: each triangle's is its number.
  template <int W>
  TriangleTree(const WideBvh<W>& wide, std::span<const Triangle> triangles,
               std::span<const std::uint32_t> keys, Executor& executor, Layout layout = Layout::full);

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

  Layout layout() const { return layout_; }
  const char* pool() const { return pool_.data(); }
  /// The bytes behind a reference of the pool.
  const char* at(ChildRef ref) const { return pool_.data() + std::size_t(ref.index()) * kUnit; }
  std::size_t block_bytes() const {
    return layout_ == Layout::full ? sizeof(TriangleBlock) : sizeof(CompactBlock);
  }

  /// The i-th of all blocks, and the i-th of a leaf. In a compact tree these are put together when asked for.
  TriangleBlock block(std::size_t i) const {
    return block_from(pool_.data() + blocks_at_ + i * block_bytes());
  }
  TriangleBlock block_of(ChildRef leaf, std::size_t i) const {
    return block_from(at(leaf) + i * block_bytes());
  }
  /// A triangle of the block that a hit names; its key.
  Triangle triangle(std::uint32_t block, std::uint32_t lane) const {
    const char* p = pool_.data() + std::size_t(block) * kUnit;
    return layout_ == Layout::full ? reinterpret_cast<const TriangleBlock*>(p)->triangle(lane)
                                   : reinterpret_cast<const CompactBlock*>(p)->triangle(lane);
  }
  std::uint32_t key(std::uint32_t block, std::uint32_t lane) const {
    const char* p = pool_.data() + std::size_t(block) * kUnit;
    return layout_ == Layout::full ? reinterpret_cast<const TriangleBlock*>(p)->key[lane]
                                   : reinterpret_cast<const CompactBlock*>(p)->key[lane];
  }

  /// A node of a tree with W = width() children; references count in units. For the layout that the name
  /// says.
  template <int W>
  const WideNode<W>& full_node(ChildRef node) const {
    return *reinterpret_cast<const WideNode<W>*>(at(node));
  }
  template <int W>
  const QuantizedNode<W>& compact_node(ChildRef node) const {
    return *reinterpret_cast<const QuantizedNode<W>*>(at(node));
  }

 private:
  template <int W, class Node, class Block>
  void pack(const WideBvh<W>& wide, const Fetch& fetch, Executor& executor);
  template <int W>
  std::size_t node_size() const {
    return layout_ == Layout::full ? sizeof(WideNode<W>) : sizeof(QuantizedNode<W>);
  }
  TriangleBlock block_from(const char* p) const {
    return layout_ == Layout::full ? *reinterpret_cast<const TriangleBlock*>(p)
                                   : expand(*reinterpret_cast<const CompactBlock*>(p));
  }
  static TriangleBlock expand(const CompactBlock& compact);

  MemoryBlock pool_;
  Layout layout_ = Layout::full;
  std::size_t blocks_at_ = 0, node_count_ = 0, block_count_ = 0;
  int width_ = 8, max_stack_ = 0;
  bool is_ordinary_ = true, has_parts_ = false;
  Box3 box_;
};

extern template TriangleTree::TriangleTree(const WideBvh<4>&, const Fetch&, Layout, Executor&);
extern template TriangleTree::TriangleTree(const WideBvh<8>&, const Fetch&, Layout, Executor&);
extern template TriangleTree::TriangleTree(const WideBvh<16>&, const Fetch&, Layout, Executor&);
extern template TriangleTree::TriangleTree(const WideBvh<4>&, std::span<const Triangle>,
                                           std::span<const std::uint32_t>, Executor&, Layout);
extern template TriangleTree::TriangleTree(const WideBvh<8>&, std::span<const Triangle>,
                                           std::span<const std::uint32_t>, Executor&, Layout);
extern template TriangleTree::TriangleTree(const WideBvh<16>&, std::span<const Triangle>,
                                           std::span<const std::uint32_t>, Executor&, Layout);
extern template WideBvh<4> TriangleTree::unpack() const;
extern template WideBvh<8> TriangleTree::unpack() const;
extern template WideBvh<16> TriangleTree::unpack() const;

}  // namespace boxwood::simd
