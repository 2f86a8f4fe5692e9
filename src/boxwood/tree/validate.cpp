#include "boxwood/tree/validate.h"

namespace boxwood {
namespace {

std::string text(std::uint64_t n) {
  return std::to_string(n);
}
std::string node_text(std::uint64_t i) {
  return "node " + text(i);
}

/// Invariants 2, 3 and 6, one node at a time, parents first; then what is left of 4.
std::string check_links(const Bvh& bvh) {
  const std::size_t node_count = bvh.nodes.size(), prim_count = bvh.prim_ids.size();
  constexpr int kUnreached = -1;
  std::vector<int> depth(node_count, kUnreached);
  std::vector<bool> is_owned(prim_count, false);
  depth[0] = 0;

  // Children come after their parent,
  // so when a node's turn comes its parent has been seen, and no cycle can be walked.
  for (std::size_t i = 0; i < node_count; ++i) {
    const BvhNode& node = bvh.nodes[i];
    if (depth[i] == kUnreached) return node_text(i) + " has no parent";
    if (depth[i] > kMaxDepth)
      return node_text(i) + " lies at depth " + text(depth[i]) + ", deeper than " + text(kMaxDepth);
    const std::uint64_t first = node.first_index;

    if (node.is_leaf()) {
      if (first + node.count > prim_count)
        return node_text(i) + " is a leaf that owns positions " + text(first) + " to " +
               text(first + node.count - 1) + " of prim_ids, which has " + text(prim_count);
      for (std::uint64_t k = first; k < first + node.count; ++k) {
        if (is_owned[k])
          return node_text(i) + " is a leaf that owns position " + text(k) + " of prim_ids, as another does";
        is_owned[k] = true;
      }
      continue;
    }
    if (first <= i) return node_text(i) + " has its children at " + text(first) + ", not after itself";
    if (first + 1 >= node_count)
      return node_text(i) + " has its children at " + text(first) + " and " + text(first + 1) + " of " +
             text(node_count) + " nodes";
    for (const std::uint64_t child : {first, first + 1}) {
      if (depth[child] != kUnreached) return node_text(child) + " has two parents; one is node " + text(i);
      depth[child] = depth[i] + 1;
    }
  }
  for (std::size_t k = 0; k < prim_count; ++k)
    if (!is_owned[k]) return "no leaf owns position " + text(k) + " of prim_ids";
  return "";
}

/// Invariant 4, the primitives: prim_ids is a permutation.
std::string check_primitives(const Bvh& bvh) {
  std::vector<bool> is_seen(bvh.prim_ids.size(), false);
  for (std::size_t k = 0; k < bvh.prim_ids.size(); ++k) {
    const std::uint32_t prim = bvh.prim_ids[k].value;
    if (prim >= is_seen.size())
      return "position " + text(k) + " of prim_ids names primitive " + text(prim) + ", but there are " +
             text(is_seen.size());
    if (is_seen[prim])
      return "position " + text(k) + " of prim_ids names primitive " + text(prim) + " a second time";
    is_seen[prim] = true;
  }
  return "";
}

/// Invariant 5, the nodes.
std::string check_children(const Bvh& bvh) {
  for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    if (node.is_leaf()) continue;
    for (const std::uint32_t child : {node.first_index, node.first_index + 1})
      if (!node.box.contains(bvh.nodes[child].box))
        return node_text(i) + " has a box that does not hold the box of its child, node " + text(child);
  }
  return "";
}

/// Invariant 5, the leaves.
std::string check_leaves(const Bvh& bvh, std::span<const Box3> boxes) {
  for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    if (!node.is_leaf()) continue;
    for (std::uint32_t k = 0; k < node.count; ++k) {
      const PrimId prim = bvh.prim_ids[node.first_index + k];
      if (!node.box.contains(boxes[prim.value]))
        return node_text(i) + " is a leaf with a box that does not hold the box of primitive " +
               text(prim.value);
    }
  }
  return "";
}

/// Invariants 4 and 5, the leaves, where primitives may repeat.
std::string check_parts(const Bvh& bvh, std::span<const Box3> boxes) {
  std::vector<Box3> covered(boxes.size());
  std::vector<std::size_t> seen_in(boxes.size(), bvh.nodes.size());
  for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    if (!node.is_leaf()) continue;
    for (std::uint32_t k = 0; k < node.count; ++k) {
      const std::uint32_t prim = bvh.prim_ids[node.first_index + k].value;
      if (prim >= boxes.size())
        return "position " + text(node.first_index + k) + " of prim_ids names primitive " + text(prim) +
               ", but there are " + text(boxes.size());
      if (seen_in[prim] == i) return node_text(i) + " is a leaf with primitive " + text(prim) + " twice";
      seen_in[prim] = i;
      covered[prim].extend(node.box);
    }
  }
  for (std::size_t prim = 0; prim < boxes.size(); ++prim) {
    if (seen_in[prim] == bvh.nodes.size()) return "no leaf has primitive " + text(prim);
    if (!covered[prim].contains(boxes[prim]))
      return "the leaves of primitive " + text(prim) + " do not reach as far as its box";
  }
  return "";
}

}  // namespace

std::string validate(const Bvh& bvh, std::span<const Box3> boxes, Repeats repeats) {
  if (repeats == Repeats::allowed ? bvh.prim_ids.size() < boxes.size() : bvh.prim_ids.size() != boxes.size())
    return "prim_ids has " + text(bvh.prim_ids.size()) + " entries for " + text(boxes.size()) + " primitives";
  if (bvh.nodes.empty() != boxes.empty())
    return "there are " + text(bvh.nodes.size()) + " nodes for " + text(boxes.size()) + " primitives";
  if (bvh.nodes.empty()) return "";

  // Boxes are looked at last: only then is it safe to follow indices.
  const bool may_repeat = repeats == Repeats::allowed;
  std::string broken = check_links(bvh);
  if (broken.empty() && !may_repeat) broken = check_primitives(bvh);
  if (broken.empty()) broken = check_children(bvh);
  if (broken.empty()) broken = may_repeat ? check_parts(bvh, boxes) : check_leaves(bvh, boxes);
  return broken;
}

}  // namespace boxwood
