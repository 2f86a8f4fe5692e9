#include "boxwood/simd/triangle_tree.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>

namespace boxwood::simd {
namespace {

/// How far a walk may go.
struct Reach {
  int depth = 0;      ///< Of the deepest node.
  int max_stack = 0;  ///< The most children that are ever left behind.
};

/// A walk leaves at most all children but one behind at each level. In a compact node a ray may seem to enter
/// empty children too, where steps are next to nothing.
template <int W>
Reach find_reach(const WideBvh<W>& wide, Layout layout) {
  std::vector<Reach> above(wide.nodes.size());  // children stand behind their parents
  Reach most;
  for (std::size_t i = 0; i < wide.nodes.size(); ++i) {
    int children = 0;
    for (const ChildRef child : wide.nodes[i].children) children += !child.is_empty();
    if (layout == Layout::compact) children = W;
    const int left = above[i].max_stack + children;
    most = {std::max(most.depth, above[i].depth), std::max(most.max_stack, left)};
    for (const ChildRef child : wide.nodes[i].children)
      if (!child.is_leaf()) above[child.index()] = {above[i].depth + 1, left - 1};
  }
  return most;
}

/// Takes from the boxes of children what sticks out of their parent's: who comes to a child has entered both.
template <int W>
void clip_to_parents(WideBvh<W>& wide) {
  std::vector<Box3> own(wide.nodes.size(), wide.box);
  for (std::size_t i = 0; i < wide.nodes.size(); ++i)
    for (int c = 0; c < W; ++c) {
      const ChildRef child = wide.nodes[i].children[c];
      if (child.is_empty()) continue;
      const Box3 box = wide.nodes[i].box(c);
      const Box3 inside{max(box.lower, own[i].lower), min(box.upper, own[i].upper)};
      wide.nodes[i].set(c, inside, child);
      if (!child.is_leaf() && child.index() < own.size()) own[child.index()] = inside;
    }
}

void put(TriangleBlock& block, int lane, const Corners& corners, std::uint32_t key) {
  const Triangle t = corners.triangle();
  const float v[9] = {t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z};
  for (int k = 0; k < 9; ++k) block.v[k / 3][k % 3][lane] = v[k];
  block.key[lane] = key;
}
void put(CompactBlock& block, int lane, const Corners& corners, std::uint32_t key) {
  block.vertices[lane] = corners.vertices;
  for (int k = 0; k < 3; ++k) block.index[k][lane] = corners.index[k];
  block.key[lane] = key;
}

}  // namespace

TriangleBlock TriangleTree::expand(const CompactBlock& compact) {
  TriangleBlock block;
  for (int lane = 0; lane < kBlockWidth; ++lane)
    put(block, lane,
        {compact.vertices[lane], {compact.index[0][lane], compact.index[1][lane], compact.index[2][lane]}},
        compact.key[lane]);
  return block;
}

template <int W>
TriangleTree::TriangleTree(const WideBvh<W>& wide, std::span<const Triangle> triangles,
                           std::span<const std::uint32_t> keys, Executor& executor, Layout layout)
    : TriangleTree(
          wide,
          [triangles](std::span<const PrimId> slots, Corners* out) {
            for (const PrimId slot : slots) *out++ = {&triangles[slot.value].a, {0, 1, 2}};
          },
          layout, executor) {
  if (keys.empty() || is_empty()) return;
  for (std::size_t i = 0; i < block_count_; ++i) {
    char* p = pool_.data() + blocks_at_ + i * block_bytes();
    auto& block_keys = layout_ == Layout::full ? reinterpret_cast<TriangleBlock*>(p)->key
                                               : reinterpret_cast<CompactBlock*>(p)->key;
    for (std::uint32_t& key : block_keys) key = keys[key];
  }
}

template <int W>
TriangleTree::TriangleTree(const WideBvh<W>& wide, const Fetch& fetch, Layout layout, Executor& executor)
    : layout_(layout),
      node_count_(wide.nodes.size()),
      block_count_(wide.block_count()),
      width_(W),
      has_parts_(wide.has_parts),
      box_(wide.box) {
  if (wide.is_empty()) return;
  // Blocks begin at a multiple of a line.
  blocks_at_ = node_count_ * node_size<W>();
  const std::size_t size = blocks_at_ + block_count_ * block_bytes();
  if (size >= std::uint64_t(kUnit) << 28)
    throw std::length_error("the tree and its triangles need more than 8 GB, which 28 bits cannot address");
  constexpr std::size_t kHugePage = std::size_t(2) << 20;
  pool_ = MemoryBlock(size, size >= kHugePage ? kHugePage : 64);
  is_ordinary_ = max(max_component(abs(box_.lower)), max_component(abs(box_.upper))) <= kLargestReach;
  const Reach reach = find_reach(wide, layout);
  if (reach.depth > kMaxWideDepth)
    throw std::length_error("a node of the tree lies at depth " + std::to_string(reach.depth) +
                            ", expected at most " + std::to_string(kMaxWideDepth));
  max_stack_ = reach.max_stack;
  if (layout == Layout::full)
    pack<W, WideNode<W>, TriangleBlock>(wide, fetch, executor);
  else
    pack<W, QuantizedNode<W>, CompactBlock>(wide, fetch, executor);
}

template <int W, class Node, class Block>
void TriangleTree::pack(const WideBvh<W>& wide, const Fetch& fetch, Executor& executor) {
  // Copy the nodes, with references in units.
  constexpr std::size_t kGrain = 1 << 10;
  const auto to_units = [&](ChildRef ref) {
    if (ref.is_empty()) return ChildRef{};
    const std::size_t offset =
        ref.is_leaf() ? blocks_at_ + ref.index() * sizeof(Block) : ref.index() * sizeof(Node);
    return ChildRef{static_cast<std::uint32_t>(offset / kUnit) << 4 | (ref.bits & 15)};
  };
  auto* nodes = reinterpret_cast<Node*>(pool_.data());
  parallel_for(executor, 0, node_count_, kGrain, [&](std::size_t i) {
    Node* node = new (nodes + i) Node(wide.nodes[i]);
    for (ChildRef& child : node->children) child = to_units(child);
  });

  // Fetch the triangles, of many blocks at once: whoever tells the corners can then ask for memory ahead.
  constexpr std::size_t kBlocks = kMaxFetch / kBlockWidth;
  auto* blocks = reinterpret_cast<Block*>(pool_.data() + blocks_at_);
  parallel_for(executor, 0, (block_count_ + kBlocks - 1) / kBlocks, kGrain / kBlocks, [&](std::size_t part) {
    const std::size_t first = part * kBlocks, count = std::min(kBlocks, block_count_ - first);
    const std::span<const PrimId> slots(&wide.slots[first * kBlockWidth], count * kBlockWidth);
    Corners corners[kMaxFetch];
    fetch(slots, corners);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      Block& block = blocks[first + i / kBlockWidth];
      put(block, static_cast<int>(i % kBlockWidth), corners[i], slots[i].value);
    }
  });
}

template <int W>
WideBvh<W> TriangleTree::unpack() const {
  WideBvh<W> wide;
  wide.box = box_;
  wide.has_parts = has_parts_;
  const auto from_units = [&](ChildRef ref) {
    if (ref.is_empty()) return ref;
    constexpr std::uint32_t kNowhere = (1u << 28) - 1;
    const std::size_t offset = ref.index() * kUnit, begin = ref.is_leaf() ? blocks_at_ : 0,
                      size = ref.is_leaf() ? block_bytes() : node_size<W>();
    const bool is_somewhere = offset >= begin && (offset - begin) % size == 0;
    const std::uint32_t index = is_somewhere ? static_cast<std::uint32_t>((offset - begin) / size) : kNowhere;
    return ChildRef{index << 4 | (ref.bits & 15)};
  };
  for (std::size_t i = 0; i < node_count_; ++i) {
    const ChildRef at{static_cast<std::uint32_t>(i * node_size<W>() / kUnit) << 4};
    wide.nodes.push_back(layout_ == Layout::full ? full_node<W>(at) : compact_node<W>(at).widen());
    for (ChildRef& child : wide.nodes.back().children) child = from_units(child);
  }
  for (std::size_t i = 0; i < block_count_; ++i)
    for (const std::uint32_t key : block(i).key) wide.slots.push_back(PrimId(key));
  if (layout_ == Layout::compact) clip_to_parents(wide);
  return wide;
}

template TriangleTree::TriangleTree(const WideBvh<4>&, const Fetch&, Layout, Executor&);
template TriangleTree::TriangleTree(const WideBvh<8>&, const Fetch&, Layout, Executor&);
template TriangleTree::TriangleTree(const WideBvh<16>&, const Fetch&, Layout, Executor&);
template TriangleTree::TriangleTree(const WideBvh<4>&, std::span<const Triangle>,
                                    std::span<const std::uint32_t>, Executor&, Layout);
template TriangleTree::TriangleTree(const WideBvh<8>&, std::span<const Triangle>,
                                    std::span<const std::uint32_t>, Executor&, Layout);
template TriangleTree::TriangleTree(const WideBvh<16>&, std::span<const Triangle>,
                                    std::span<const std::uint32_t>, Executor&, Layout);
template WideBvh<4> TriangleTree::unpack() const;
template WideBvh<8> TriangleTree::unpack() const;
template WideBvh<16> TriangleTree::unpack() const;

}  // namespace boxwood::simd
