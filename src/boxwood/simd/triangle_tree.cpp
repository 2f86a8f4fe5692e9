#include "boxwood/simd/triangle_tree.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>

namespace boxwood::simd {
namespace {

/// A walk leaves at most all children but one behind at each level.
template <int W>
int find_max_stack(const WideBvh<W>& wide) {
  std::vector<int> left_above(wide.nodes.size(), 0);  // children stand behind their parents
  int most = 0;
  for (std::size_t i = 0; i < wide.nodes.size(); ++i) {
    int children = 0;
    for (const ChildRef child : wide.nodes[i].children) children += !child.is_empty();
    const int left = left_above[i] + children;
    most = std::max(most, left);
    for (const ChildRef child : wide.nodes[i].children)
      if (!child.is_leaf()) left_above[child.index()] = left - 1;
  }
  return most;
}

}  // namespace

template <int W>
TriangleTree::TriangleTree(const WideBvh<W>& wide, std::span<const Triangle> triangles,
                           std::span<const std::uint32_t> keys, Executor& executor)
    : TriangleTree(
          wide,
          [triangles](const PrimId* slots, Triangle* out) {
            for (int lane = 0; lane < kBlockWidth; ++lane) out[lane] = triangles[slots[lane].value];
          },
          executor) {
  if (keys.empty() || is_empty()) return;
  auto* blocks = reinterpret_cast<TriangleBlock*>(pool_.data() + blocks_at_);
  for (std::size_t i = 0; i < block_count_; ++i)
    for (std::uint32_t& key : blocks[i].key) key = keys[key];
}

template <int W>
TriangleTree::TriangleTree(const WideBvh<W>& wide, const Fetch& fetch, Executor& executor)
    : node_count_(wide.nodes.size()),
      block_count_(wide.block_count()),
      width_(W),
      has_parts_(wide.has_parts),
      box_(wide.box) {
  if (wide.is_empty()) return;
  blocks_at_ = node_count_ * sizeof(WideNode<W>);
  const std::size_t size = blocks_at_ + block_count_ * sizeof(TriangleBlock);
  if (size >= kUnit << 28)
    throw std::length_error("the tree and its triangles need more than 8 GB, which 28 bits cannot address");
  pool_ = HugeBuffer(size);
  is_ordinary_ = max(max_component(abs(box_.lower)), max_component(abs(box_.upper))) <= kLargestReach;
  max_stack_ = find_max_stack(wide);
  if (max_stack_ > kMaxWideStack<W>)
    throw std::length_error("a walk of the tree leaves up to " + std::to_string(max_stack_) +
                            " children for later, expected at most " + std::to_string(kMaxWideStack<W>));

  // Copy the nodes, with references in units.
  constexpr std::size_t kGrain = 1 << 10;
  const auto to_units = [&](ChildRef ref) {
    if (ref.is_empty()) return ChildRef{};
    const std::size_t offset =
        ref.is_leaf() ? blocks_at_ + ref.index() * sizeof(TriangleBlock) : ref.index() * sizeof(WideNode<W>);
    return ChildRef{static_cast<std::uint32_t>(offset / kUnit) << 4 | (ref.bits & 15)};
  };
  auto* nodes = reinterpret_cast<WideNode<W>*>(pool_.data());
  parallel_for(executor, 0, node_count_, kGrain, [&](std::size_t i) {
    WideNode<W>* node = new (nodes + i) WideNode<W>(wide.nodes[i]);
    for (ChildRef& child : node->children) child = to_units(child);
  });

  // Fetch the triangles.
  auto* blocks = reinterpret_cast<TriangleBlock*>(pool_.data() + blocks_at_);
  parallel_for(executor, 0, block_count_, kGrain, [&](std::size_t i) {
    TriangleBlock& block = *new (blocks + i) TriangleBlock;
    const PrimId* slots = &wide.slots[i * kBlockWidth];
    Triangle triangles[kBlockWidth];
    fetch(slots, triangles);
    for (int lane = 0; lane < kBlockWidth; ++lane) {
      const Triangle& t = triangles[lane];
      const float v[9] = {t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z};
      for (int k = 0; k < 9; ++k) block.v[k / 3][k % 3][lane] = v[k];
      block.key[lane] = slots[lane].value;
    }
  });
}

template <int W>
WideBvh<W> TriangleTree::unpack() const {
  WideBvh<W> wide;
  wide.box = box_;
  wide.has_parts = has_parts_;
  const std::span<const WideNode<W>> packed = nodes<W>();
  wide.nodes.assign(packed.begin(), packed.end());
  const auto from_units = [&](ChildRef ref) {
    if (ref.is_empty()) return ref;
    constexpr std::uint32_t kNowhere = (1u << 28) - 1;
    const std::size_t offset = ref.index() * kUnit, begin = ref.is_leaf() ? blocks_at_ : 0,
                      size = ref.is_leaf() ? sizeof(TriangleBlock) : sizeof(WideNode<W>);
    const bool is_somewhere = offset >= begin && (offset - begin) % size == 0;
    const std::uint32_t index = is_somewhere ? static_cast<std::uint32_t>((offset - begin) / size) : kNowhere;
    return ChildRef{index << 4 | (ref.bits & 15)};
  };
  for (WideNode<W>& node : wide.nodes)
    for (ChildRef& child : node.children) child = from_units(child);
  for (const TriangleBlock& block : blocks())
    for (const std::uint32_t key : block.key) wide.slots.push_back(PrimId(key));
  return wide;
}

template TriangleTree::TriangleTree(const WideBvh<4>&, const Fetch&, Executor&);
template TriangleTree::TriangleTree(const WideBvh<8>&, const Fetch&, Executor&);
template TriangleTree::TriangleTree(const WideBvh<4>&, std::span<const Triangle>,
                                    std::span<const std::uint32_t>, Executor&);
template TriangleTree::TriangleTree(const WideBvh<8>&, std::span<const Triangle>,
                                    std::span<const std::uint32_t>, Executor&);
template WideBvh<4> TriangleTree::unpack() const;
template WideBvh<8> TriangleTree::unpack() const;

}  // namespace boxwood::simd
