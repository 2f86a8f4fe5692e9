#include "boxwood/simd/box_tree.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "boxwood/simd/triangle_tree.h"

namespace boxwood::simd {
namespace {

/// Takes the leaves of a wide tree apart.
template <int W>
class Unpacker {
 public:
  Unpacker(const WideBvh<W>& wide, std::span<const Box3> boxes)
      : wide_(wide), boxes_(boxes), nodes_(wide.nodes) {}

  std::vector<WideNode<W>> run() {
    for (std::size_t i = 0; i < wide_.nodes.size(); ++i)
      for (int c = 0; c < W; ++c) {
        const ChildRef child = wide_.nodes[i].children[c];
        if (child.is_leaf() && !child.is_empty()) put(i, c, items_of(child));
      }
    return std::move(nodes_);
  }

 private:
  std::vector<PrimId> items_of(ChildRef leaf) const {
    std::vector<PrimId> items;
    for (std::uint32_t block = 0; block < leaf.blocks(); ++block) {
      const PrimId* slots = &wide_.slots[(std::size_t(leaf.index()) + block) * kBlockWidth];
      for (int lane = 0; lane < kBlockWidth; ++lane)
        if (!is_padding(slots, lane)) items.push_back(slots[lane]);
    }
    return items;
  }

  /// Makes the items a child: the only one itself, several as a node, more than fit as nodes below one.
  void put(std::size_t node, int child, std::span<const PrimId> items) {
    Box3 box;
    for (const PrimId item : items) box.extend(boxes_[item.value]);
    if (items.size() == 1) {
      nodes_[node].set(child, box, ChildRef::leaf(items[0].value, 1));
      return;
    }
    const std::size_t below = nodes_.size();
    nodes_.emplace_back();
    nodes_[node].set(child, box, ChildRef::node(static_cast<std::uint32_t>(below)));
    const std::size_t share = (items.size() + W - 1) / W;
    for (int c = 0; !items.empty(); ++c) {
      const std::size_t count = std::min(share, items.size());
      put(below, c, items.first(count));
      items = items.subspan(count);
    }
  }

  const WideBvh<W>& wide_;
  std::span<const Box3> boxes_;
  std::vector<WideNode<W>> nodes_;
};

/// How far a walk may go: the depth of the deepest node, and the most children that it leaves behind.
struct Reach {
  int depth = 0, max_stack = 0;
};

template <int W>
Reach find_reach(const std::vector<WideNode<W>>& nodes) {
  std::vector<Reach> above(nodes.size());  // children stand behind their parents
  Reach most;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    int left = above[i].max_stack;
    for (const ChildRef child : nodes[i].children) left += !child.is_empty();
    most = {std::max(most.depth, above[i].depth), std::max(most.max_stack, left)};
    for (const ChildRef child : nodes[i].children)
      if (!child.is_leaf()) above[child.index()] = {above[i].depth + 1, left - 1};
  }
  return most;
}

}  // namespace

template <int W>
BoxTree::BoxTree(const WideBvh<W>& wide, std::span<const Box3> boxes) : width_(W) {
  if (wide.is_empty()) return;
  std::vector<WideNode<W>> nodes = Unpacker<W>(wide, boxes).run();
  constexpr std::uint32_t kUnits = sizeof(WideNode<W>) / TriangleTree::kUnit;  // in which kernels count
  if (nodes.size() >= (std::size_t(1) << 28) / kUnits || boxes.size() >= std::size_t(1) << 28)
    throw std::length_error("a tree of so many boxes cannot be addressed by 28 bits");
  const Reach reach = find_reach(nodes);
  max_stack_ = reach.max_stack;
  is_ordinary_ =
      max(max_component(abs(wide.box.lower)), max_component(abs(wide.box.upper))) <= kLargestReach &&
      reach.depth <= kMaxWideDepth;
  for (WideNode<W>& node : nodes)
    for (ChildRef& child : node.children) {
      if (child.is_empty()) continue;
      child = child.is_leaf() ? ChildRef{child.index() << 4 | kItem} : ChildRef::node(child.index() * kUnits);
    }
  if (nodes.size() == 1 && reach.max_stack == 1) first_ = nodes[0].children[0].bits;
  pool_ = MemoryBlock(nodes.size() * sizeof(WideNode<W>), 64);
  std::memcpy(pool_.data(), nodes.data(), pool_.size());
}

template BoxTree::BoxTree(const WideBvh<4>&, std::span<const Box3>);
template BoxTree::BoxTree(const WideBvh<8>&, std::span<const Box3>);
template BoxTree::BoxTree(const WideBvh<16>&, std::span<const Box3>);

}  // namespace boxwood::simd
