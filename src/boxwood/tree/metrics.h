// metrics.h: how good is a tree, before a ray is traced?
//
// SAH cost. The expected work of a random line that meets the root's box, in shape tests: with C = traversal
// for an interior node and C = count for a leaf (see build/cost.h),
//
//     SAH = sum over nodes  C(node) A(node) / A(root)
//
// End-point overlap. Rays begin and end *on* surfaces, and there they must enter every node whose box reaches
// over the place, also when the surface belongs elsewhere. Aila, Karras and Laine, "On Quality Metrics of
// Bounding Volume Hierarchies", HPG 2013, section 4, add up how much foreign surface lies inside each box:
//
//     EPO = sum over nodes  C(node) area(surface inside box(node), but not of primitives below node)
//           / area(surface)
//
// In a wide tree an interior node costs WideCost::node, a leaf WideCost::block for each of its blocks, and
// the root's children are the first boxes that are tested.
//
// They take the triangles for the surface. A tree knows boxes only, so here it is the faces of the
// primitives' boxes, clipped exactly: 0 when no box reaches over another primitive's, and comparable between
// trees of the same boxes.
#pragma once

#include <span>
#include <vector>

#include "boxwood/tree/collapse.h"

namespace boxwood {

/// The formula above; `traversal` is the cost of a step over an interior node. A root without area counts as
/// 1 with all nodes that are as flat, so the cost is then the plain sum over all nodes. 0 for an empty tree.
/// Cost: linear.
double sah_cost(const Bvh& bvh, double traversal = 1.0);
template <int W>
double sah_cost(const WideBvh<W>& wide, WideCost cost = {});

/// The formula above; `boxes` are those that the tree was built over. 0 where no box has a surface. Cost: for
/// each primitive, a walk to everything that overlaps its box.
double end_point_overlap(const Bvh& bvh, std::span<const Box3> boxes, double traversal = 1.0);
template <int W>
double end_point_overlap(const WideBvh<W>& wide, std::span<const Box3> boxes, WideCost cost = {});

/// What can be counted.
struct TreeShape {
  std::size_t node_count = 0;  ///< In a wide tree leaves are no nodes, in a binary tree they are.
  std::size_t leaf_count = 0;
  std::size_t primitive_count = 0;  ///< In leaves; one that stands in two counts twice.
  int depth = 0;                    ///< Of the deepest node; a root alone has 0.
  double mean_leaf_depth = 0;
  /// [k]: how many leaves have k primitives; up to the largest leaf.
  std::vector<std::size_t> leaves_of_size;
  double mean_leaf_size = 0;
  std::uint32_t max_leaf_size = 0;
  std::size_t size_bytes = 0;  ///< Nodes, and prim_ids or slots.
  double bytes_per_primitive = 0;
  double mean_children = 0;     ///< Of an interior node; leaves count, empty children do not.
  std::size_t block_count = 0;  ///< 0 in a binary tree, which has no blocks.
  double block_fill = 0;        ///< The share of their slots that is no padding.
};
/// All zero for an empty tree. Cost: linear.
TreeShape tree_shape(const Bvh& bvh);
template <int W>
TreeShape tree_shape(const WideBvh<W>& wide);

extern template double sah_cost(const WideBvh<4>&, WideCost);
extern template double sah_cost(const WideBvh<8>&, WideCost);
extern template double sah_cost(const WideBvh<16>&, WideCost);
extern template double end_point_overlap(const WideBvh<4>&, std::span<const Box3>, WideCost);
extern template double end_point_overlap(const WideBvh<8>&, std::span<const Box3>, WideCost);
extern template double end_point_overlap(const WideBvh<16>&, std::span<const Box3>, WideCost);
extern template TreeShape tree_shape(const WideBvh<4>&);
extern template TreeShape tree_shape(const WideBvh<8>&);
extern template TreeShape tree_shape(const WideBvh<16>&);

}  // namespace boxwood
