// metrics_wide.cpp: the measures of metrics.h for wide trees, whose boxes stand in the parents.
#include <algorithm>

#include "boxwood/tree/face_area.h"
#include "boxwood/tree/metrics.h"

namespace boxwood {
namespace {

double step_cost(ChildRef ref, WideCost cost) {
  return ref.is_leaf() ? double(ref.blocks()) * cost.block : double(cost.node);
}

/// Calls f(node index, child) for each child that is not empty.
template <int W, class F>
void for_children(const WideBvh<W>& wide, const F& f) {
  for (std::uint32_t i = 0; i < wide.nodes.size(); ++i)
    for (int c = 0; c < W; ++c)
      if (!wide.nodes[i].children[c].is_empty()) f(i, c);
}

/// Calls f(slot) for each primitive of a leaf.
template <int W, class F>
void for_primitives(const WideBvh<W>& wide, ChildRef leaf, const F& f) {
  for (std::size_t b = leaf.index(); b < leaf.index() + leaf.blocks(); ++b) {
    const PrimId* slots = &wide.slots[b * kBlockWidth];
    for (int k = 0; k < kBlockWidth; ++k)
      if (!is_padding(slots, k)) f(slots[k]);
  }
}

}  // namespace

template <int W>
double sah_cost(const WideBvh<W>& wide, WideCost cost) {
  if (wide.is_empty()) return 0;
  const double root_area = half_area(wide.box);
  double sum = cost.node;
  for_children(wide, [&](std::uint32_t i, int c) {
    const double share = root_area > 0 ? half_area(wide.nodes[i].box(c)) / root_area : 1.0;
    sum += step_cost(wide.nodes[i].children[c], cost) * share;
  });
  return sum;
}

template <int W>
double end_point_overlap(const WideBvh<W>& wide, std::span<const Box3> boxes, WideCost cost) {
  if (wide.is_empty()) return 0;
  constexpr std::uint32_t kNone = 0xffffffffu;

  // Know which child of which node each node is, so that the way up from a leaf can be marked. Children are
  // numbered through: node * W + child.
  std::vector<std::uint32_t> parent(wide.nodes.size(), kNone);
  for_children(wide, [&](std::uint32_t i, int c) {
    const ChildRef ref = wide.nodes[i].children[c];
    if (!ref.is_leaf()) parent[ref.index()] = i * W + static_cast<std::uint32_t>(c);
  });

  double surface = 0, overlap = 0;
  std::vector<std::uint32_t> marked_by(wide.nodes.size() * W, kNone), waiting;
  for_children(wide, [&](std::uint32_t i, int c) {
    const ChildRef leaf = wide.nodes[i].children[c];
    if (!leaf.is_leaf()) return;
    const std::uint32_t leaf_child = i * W + static_cast<std::uint32_t>(c);
    for (std::uint32_t k = leaf_child; k != kNone; k = parent[k / W]) marked_by[k] = leaf_child;

    for_primitives(wide, leaf, [&](PrimId prim) {
      const Box3& box = boxes[prim.value];
      surface += 2 * half_area(box);

      // Visit every child whose box the primitive's box reaches into; those on the way to it are no
      // strangers.
      waiting.assign(1, 0);
      while (!waiting.empty()) {
        const std::uint32_t n = waiting.back();
        waiting.pop_back();
        for (std::uint32_t k = 0; k < W; ++k) {
          const ChildRef ref = wide.nodes[n].children[k];
          const Box3 child_box = wide.nodes[n].box(static_cast<int>(k));
          if (ref.is_empty() || !child_box.overlaps(box)) continue;
          if (marked_by[n * W + k] != leaf_child)
            overlap += step_cost(ref, cost) * face_area_inside(box, child_box);
          if (!ref.is_leaf()) waiting.push_back(ref.index());
        }
      }
    });
  });
  return surface > 0 ? overlap / surface : 0;
}

template <int W>
TreeShape tree_shape(const WideBvh<W>& wide) {
  TreeShape shape;
  if (wide.is_empty()) return shape;
  shape.node_count = wide.nodes.size();
  shape.block_count = wide.block_count();
  shape.size_bytes = wide.size_bytes();

  // Parents come before their children.
  std::size_t children = 0;
  std::vector<int> depth(wide.nodes.size(), 0);
  for_children(wide, [&](std::uint32_t i, int c) {
    ++children;
    const ChildRef ref = wide.nodes[i].children[c];
    if (!ref.is_leaf()) {
      depth[ref.index()] = depth[i] + 1;
      shape.depth = std::max(shape.depth, depth[i] + 1);
      return;
    }
    std::uint32_t size = 0;
    for_primitives(wide, ref, [&](PrimId) { ++size; });
    ++shape.leaf_count;
    shape.mean_leaf_depth += depth[i] + 1;
    shape.primitive_count += size;
    shape.max_leaf_size = std::max(shape.max_leaf_size, size);
    if (size >= shape.leaves_of_size.size()) shape.leaves_of_size.resize(size + 1);
    ++shape.leaves_of_size[size];
  });
  shape.mean_children = double(children) / double(shape.node_count);
  if (shape.leaf_count == 0) return shape;
  shape.mean_leaf_depth /= double(shape.leaf_count);
  shape.mean_leaf_size = double(shape.primitive_count) / double(shape.leaf_count);
  shape.bytes_per_primitive = double(shape.size_bytes) / double(shape.primitive_count);
  shape.block_fill = double(shape.primitive_count) / double(shape.block_count * kBlockWidth);
  return shape;
}

template double sah_cost(const WideBvh<4>&, WideCost);
template double sah_cost(const WideBvh<8>&, WideCost);
template double sah_cost(const WideBvh<16>&, WideCost);
template double end_point_overlap(const WideBvh<4>&, std::span<const Box3>, WideCost);
template double end_point_overlap(const WideBvh<8>&, std::span<const Box3>, WideCost);
template double end_point_overlap(const WideBvh<16>&, std::span<const Box3>, WideCost);
template TreeShape tree_shape(const WideBvh<4>&);
template TreeShape tree_shape(const WideBvh<8>&);
template TreeShape tree_shape(const WideBvh<16>&);

}  // namespace boxwood
