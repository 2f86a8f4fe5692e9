#include "boxwood/tree/metrics.h"

#include <algorithm>

#include "boxwood/tree/face_area.h"

namespace boxwood {
namespace {

double step_cost(const BvhNode& node, double traversal) {
  return node.is_leaf() ? node.count : traversal;
}

}  // namespace

double sah_cost(const Bvh& bvh, double traversal) {
  if (bvh.is_empty()) return 0;
  const double root_area = half_area(bvh.nodes[0].box);
  double cost = 0;
  for (const BvhNode& node : bvh.nodes)
    cost += step_cost(node, traversal) * (root_area > 0 ? half_area(node.box) / root_area : 1.0);
  return cost;
}

double end_point_overlap(const Bvh& bvh, std::span<const Box3> boxes, double traversal) {
  if (bvh.is_empty()) return 0;
  constexpr std::uint32_t kNone = 0xffffffffu;

  // Know the parent of each node, so that the nodes above a leaf can be marked.
  std::vector<std::uint32_t> parent(bvh.nodes.size(), kNone), marked_by(bvh.nodes.size(), kNone);
  for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i)
    if (!bvh.nodes[i].is_leaf()) parent[bvh.nodes[i].first_index] = parent[bvh.nodes[i].first_index + 1] = i;

  double surface = 0, overlap = 0;
  std::vector<std::uint32_t> waiting;
  for (std::uint32_t leaf = 0; leaf < bvh.nodes.size(); ++leaf) {
    const BvhNode& owner = bvh.nodes[leaf];
    if (!owner.is_leaf()) continue;
    for (std::uint32_t i = leaf; i != kNone; i = parent[i]) marked_by[i] = leaf;

    for (std::uint32_t k = 0; k < owner.count; ++k) {
      const Box3& box = boxes[bvh.prim_ids[owner.first_index + k].value];
      surface += 2 * half_area(box);

      // Visit every node that the primitive's box reaches into; those above its leaf are no strangers to it.
      waiting.assign(1, 0);
      while (!waiting.empty()) {
        const std::uint32_t i = waiting.back();
        const BvhNode& node = bvh.nodes[i];
        waiting.pop_back();
        if (!node.box.overlaps(box)) continue;
        if (marked_by[i] != leaf) overlap += step_cost(node, traversal) * face_area_inside(box, node.box);
        if (!node.is_leaf()) waiting.insert(waiting.end(), {node.first_index, node.first_index + 1});
      }
    }
  }
  return surface > 0 ? overlap / surface : 0;
}

TreeShape tree_shape(const Bvh& bvh) {
  TreeShape shape;
  if (bvh.is_empty()) return shape;
  shape.node_count = bvh.nodes.size();
  shape.primitive_count = bvh.prim_ids.size();
  shape.size_bytes = bvh.size_bytes();
  shape.bytes_per_primitive = double(shape.size_bytes) / double(shape.primitive_count);

  // Parents come before their children.
  std::vector<int> depth(bvh.nodes.size(), 0);
  for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    shape.depth = std::max(shape.depth, depth[i]);
    if (!node.is_leaf()) {
      depth[node.first_index] = depth[node.first_index + 1] = depth[i] + 1;
      continue;
    }
    ++shape.leaf_count;
    shape.mean_leaf_depth += depth[i];
    shape.max_leaf_size = std::max(shape.max_leaf_size, node.count);
    if (node.count >= shape.leaves_of_size.size()) shape.leaves_of_size.resize(node.count + 1);
    ++shape.leaves_of_size[node.count];
  }
  shape.mean_leaf_depth /= double(shape.leaf_count);
  shape.mean_leaf_size = double(shape.primitive_count) / double(shape.leaf_count);
  if (shape.node_count > shape.leaf_count) shape.mean_children = 2;
  return shape;
}

}  // namespace boxwood
