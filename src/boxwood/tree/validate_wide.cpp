// validate_wide.cpp: the invariants of wide.h, in an order in which each check may trust those before it.
#include "boxwood/tree/validate.h"

namespace boxwood {
namespace {

std::string text(std::uint64_t n) {
  return std::to_string(n);
}
std::string child_text(std::size_t node, int child) {
  return "child " + std::to_string(child) + " of node " + text(node);
}

/// Where references lead: invariants 2, 3, 6 and the blocks of 4. Parents come first, so when a node's turn
/// comes its depth is known, and no cycle can be walked.
template <int W>
std::string check_links(const WideBvh<W>& wide) {
  constexpr int kUnreached = -1;
  std::vector<int> depth(wide.nodes.size(), kUnreached);
  std::vector<bool> is_owned(wide.block_count(), false);
  depth[0] = 0;
  for (std::size_t i = 0; i < wide.nodes.size(); ++i) {
    if (depth[i] == kUnreached) return "node " + text(i) + " has no parent";
    if (depth[i] > kMaxWideDepth)
      return "node " + text(i) + " lies at depth " + text(depth[i]) + ", deeper than " + text(kMaxWideDepth);
    for (int c = 0; c < W; ++c) {
      const ChildRef ref = wide.nodes[i].children[c];
      if (ref.is_empty()) {
        if (wide.nodes[i].box(c) != Box3{}) return child_text(i, c) + " is empty, but its box is not";
      } else if (ref.is_leaf()) {
        for (std::size_t b = ref.index(); b < std::size_t(ref.index()) + ref.blocks(); ++b) {
          if (b >= is_owned.size())
            return child_text(i, c) + " is a leaf with block " + text(b) + " of " + text(is_owned.size());
          if (is_owned[b]) return child_text(i, c) + " is a leaf with block " + text(b) + ", as another is";
          is_owned[b] = true;
        }
      } else if ((ref.bits & 15) != 0) {
        return child_text(i, c) + " has a reference that is neither a node nor a leaf";
      } else if (ref.index() <= i || ref.index() >= wide.nodes.size()) {
        return child_text(i, c) + " is node " + text(ref.index()) +
               ", expected one behind its parent and of " + text(wide.nodes.size());
      } else if (depth[ref.index()] != kUnreached) {
        return "node " + text(ref.index()) + " has two parents; one is node " + text(i);
      } else {
        depth[ref.index()] = depth[i] + 1;
      }
    }
  }
  for (std::size_t b = 0; b < is_owned.size(); ++b)
    if (!is_owned[b]) return "no leaf owns block " + text(b);
  return "";
}

/// Boxes inside boxes: the rest of invariant 4.
template <int W>
std::string check_boxes(const WideBvh<W>& wide) {
  std::vector<Box3> box(wide.nodes.size());
  box[0] = wide.box;
  for (std::size_t i = 0; i < wide.nodes.size(); ++i)
    for (int c = 0; c < W; ++c) {
      const ChildRef ref = wide.nodes[i].children[c];
      if (ref.is_empty()) continue;
      const Box3 child_box = wide.nodes[i].box(c);
      // An empty box passes as contained in any; NaN must not pass as empty.
      if (child_box.is_empty() || !box[i].contains(child_box))
        return child_text(i, c) + " has a box that the box of its node does not hold";
      if (!ref.is_leaf()) box[ref.index()] = child_box;
    }
  return "";
}

/// Invariant 5.
template <int W>
std::string check_primitives(const WideBvh<W>& wide, std::span<const Box3> boxes) {
  std::vector<Box3> reach(boxes.size());  // of the leaves that a primitive stands in, together
  constexpr std::uint32_t kNoLeaf = 0xffffffffu;
  std::vector<std::uint32_t> last_leaf(boxes.size(), kNoLeaf);
  for (std::size_t i = 0; i < wide.nodes.size(); ++i)
    for (int c = 0; c < W; ++c) {
      const ChildRef leaf = wide.nodes[i].children[c];
      if (!leaf.is_leaf() || leaf.is_empty()) continue;
      const Box3 leaf_box = wide.nodes[i].box(c);
      for (std::size_t b = leaf.index(); b < leaf.index() + leaf.blocks(); ++b)
        for (int k = 0; k < kBlockWidth; ++k) {
          const PrimId* slots = &wide.slots[b * kBlockWidth];
          const std::uint32_t prim = slots[k].value;
          if (prim >= boxes.size())
            return "block " + text(b) + " names primitive " + text(prim) + ", but there are " +
                   text(boxes.size());
          if (is_padding(slots, k)) continue;
          if (last_leaf[prim] == leaf.index())
            return "block " + text(b) + " names primitive " + text(prim) +
                   ", which stands in its leaf already";
          if (!boxes[prim].is_empty() && !leaf_box.overlaps(boxes[prim]))
            return child_text(i, c) + " is a leaf whose box does not touch primitive " + text(prim);
          if (last_leaf[prim] != kNoLeaf && !wide.has_parts)
            return "block " + text(b) + " names primitive " + text(prim) +
                   ", which stands in another leaf, but the tree has no parts";
          last_leaf[prim] = leaf.index();
          reach[prim].extend(leaf_box);
        }
    }
  for (std::size_t prim = 0; prim < boxes.size(); ++prim) {
    if (boxes[prim].is_empty()) continue;
    if (last_leaf[prim] == kNoLeaf) return "no leaf holds primitive " + text(prim);
    if (!reach[prim].contains(boxes[prim]))
      return "the box of primitive " + text(prim) + " reaches out of the leaves that it stands in";
  }
  return "";
}

}  // namespace

template <int W>
std::string validate(const WideBvh<W>& wide, std::span<const Box3> boxes) {
  if (wide.slots.size() % kBlockWidth != 0)
    return "there are " + text(wide.slots.size()) + " slots, expected whole blocks of " + text(kBlockWidth);
  bool is_any = false;
  for (const Box3& box : boxes) is_any = is_any || !box.is_empty();
  if (wide.nodes.empty() && (is_any || !wide.slots.empty()))
    return "there are no nodes for " + text(boxes.size()) + " primitives";
  if (wide.nodes.empty()) return "";

  std::string broken = check_links(wide);
  if (broken.empty()) broken = check_boxes(wide);
  if (broken.empty()) broken = check_primitives(wide, boxes);
  return broken;
}

template std::string validate(const WideBvh<4>&, std::span<const Box3>);
template std::string validate(const WideBvh<8>&, std::span<const Box3>);
template std::string validate(const WideBvh<16>&, std::span<const Box3>);

}  // namespace boxwood
