// The measures of wide trees, against sums by hand and against the binary tree's.
#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/tree/collapse.h"
#include "boxwood/tree/metrics.h"
#include "support/random_tree.h"

namespace boxwood {
namespace {

/// Node 0: node 1 over the unit cube, and a leaf of two blocks (five primitives) over the upper half of the
/// box. Node 1: a leaf of one block with one primitive.
WideBvh<8> sample() {
  WideBvh<8> wide;
  wide.box = {{0, 0, 0}, {1, 1, 2}};
  wide.nodes.resize(2);
  wide.nodes[0].set(0, {{0, 0, 0}, {1, 1, 1}}, ChildRef::node(1));
  wide.nodes[0].set(1, {{0, 0, 1}, {1, 1, 2}}, ChildRef::leaf(0, 2));
  wide.nodes[1].set(5, {{0, 0, 0}, {1, 1, 0}}, ChildRef::leaf(2, 1));
  for (const int prim : {0, 1, 2, 3, 4, 4, 4, 4, 5, 5, 5, 5}) wide.slots.push_back(PrimId(prim));
  return wide;
}

TEST(MetricsWide, SahCostByHand) {
  // Half areas: root 5, cube 3, flat leaf 1.
  EXPECT_DOUBLE_EQ(sah_cost(sample(), {1, 0.5f}), 1 + 3.0 / 5 * 1 + 3.0 / 5 * 2 * 0.5 + 1.0 / 5 * 0.5);
  EXPECT_EQ(sah_cost(WideBvh<8>{}), 0);
  EXPECT_EQ(sah_cost(WideBvh<4>{}), 0);
  WideBvh<8> point = sample();
  point.box = {{0, 0, 0}, {0, 0, 0}};
  EXPECT_DOUBLE_EQ(sah_cost(point, {1, 0.5f}), 1 + 1 + 2 * 0.5 + 0.5);
}

TEST(MetricsWide, TheCollapseKnowsTheCost) {
  Random random(8);
  for (const std::size_t count : {40, 5000}) {
    std::vector<Box3> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 at = random.in_box({0, 0, 0}, {10, 10, 10});
      boxes.push_back({at, at + random.in_box({0, 0, 0}, {1, 1, 1})});
    }
    const Bvh bvh = test::random_tree(boxes, 3, 9);
    for (const WideCost cost : {WideCost{}, WideCost{1, 2}}) {
      const auto four = collapse<4>(bvh, serial_executor(), cost);
      const auto sixteen = collapse<16>(bvh, serial_executor(), cost);
      EXPECT_NEAR(four.cost, sah_cost(four, cost), 1e-4 * four.cost) << count;
      EXPECT_NEAR(sixteen.cost, sah_cost(sixteen, cost), 1e-4 * sixteen.cost) << count;
    }
  }
}

TEST(MetricsWide, ShapeByHand) {
  const TreeShape shape = tree_shape(sample());
  EXPECT_EQ(shape.node_count, 2u);
  EXPECT_EQ(shape.leaf_count, 2u);
  EXPECT_EQ(shape.block_count, 3u);
  EXPECT_EQ(shape.primitive_count, 6u);
  EXPECT_EQ(shape.depth, 1);
  EXPECT_DOUBLE_EQ(shape.mean_leaf_depth, 1.5);
  EXPECT_DOUBLE_EQ(shape.mean_children, 1.5);
  EXPECT_DOUBLE_EQ(shape.block_fill, 0.5);
  EXPECT_EQ(shape.leaves_of_size, (std::vector<std::size_t>{0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(shape.max_leaf_size, 5u);
  EXPECT_EQ(shape.size_bytes, 2 * 256u + 12 * 4u);
  EXPECT_EQ(tree_shape(WideBvh<4>{}).node_count, 0u);
}

TEST(MetricsWide, EndPointOverlapByHand) {
  // The faces of primitive 5 lie in the cube and in its own leaf; those of the others in the upper half,
  // whose lower side touches nothing but the cube's upper side.
  const WideBvh<8> wide = sample();
  std::vector<Box3> boxes(5, Box3{{0, 0, 1.5f}, {1, 1, 2}});
  boxes.push_back({{0, 0, 0}, {1, 1, 0}});
  EXPECT_EQ(end_point_overlap(wide, boxes), 0);
  boxes[0].lower.z = 0;  // now its faces reach into the cube: four sides of 1 by 1, and the bottom
  const double surface = 4 * (2 + 4 * 0.5) + (2 + 4 * 2) + 2;
  EXPECT_DOUBLE_EQ(end_point_overlap(wide, boxes, {1, 0.5f}), (5 * 1 + 1 * 0.5) / surface);
}

TEST(MetricsWide, ACollapsedTreeCostsNoMoreThanEachBinaryNodeMadeWide) {
  Random random(5);
  std::vector<Box3> boxes;
  for (int i = 0; i < 300; ++i) {
    const Vec3 corner = random.in_box({0, 0, 0}, {1, 1, 1});
    boxes.push_back({corner, corner + random.in_box(splat(0), splat(0.1f))});
  }
  const Bvh bvh = test::random_tree(boxes, 4, 1);
  double each = 0;  // every interior binary node a wide one, every leaf a block
  for (const BvhNode& node : bvh.nodes)
    each += (node.is_leaf() ? 0.5 : 1.0) * half_area(node.box) / half_area(bvh.nodes[0].box);
  const WideBvh<8> eight = collapse<8>(bvh, serial_executor(), {1, 0.5f});
  const WideBvh<4> four = collapse<4>(bvh, serial_executor(), {1, 0.5f});
  const WideBvh<16> sixteen = collapse<16>(bvh, serial_executor(), {1, 0.5f});
  EXPECT_LE(sah_cost(sixteen, {1, 0.5f}), sah_cost(eight, {1, 0.5f}) * (1 + 1e-5));
  EXPECT_LE(sah_cost(eight, {1, 0.5f}), sah_cost(four, {1, 0.5f}) * (1 + 1e-5));
  EXPECT_LE(sah_cost(four, {1, 0.5f}), each * (1 + 1e-5));
  EXPECT_EQ(tree_shape(eight).primitive_count, boxes.size());
  EXPECT_LE(tree_shape(eight).depth, tree_shape(bvh).depth);
}

}  // namespace
}  // namespace boxwood
