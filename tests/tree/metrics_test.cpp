// Metrics against small trees whose numbers can be worked out by hand, and against sampling.
#include "boxwood/tree/metrics.h"

#include <gtest/gtest.h>

#include "boxwood/core/random.h"

namespace boxwood {
namespace {

/// Two unit cubes, `gap` apart along x (negative: overlapping), each in a leaf of its own.
struct Pair {
  std::vector<Box3> boxes;
  Bvh bvh;
  explicit Pair(float gap) {
    boxes = {{{0, 0, 0}, {1, 1, 1}}, {{1 + gap, 0, 0}, {2 + gap, 1, 1}}};
    bvh.prim_ids = {PrimId(0), PrimId(1)};
    bvh.nodes = {{unite(boxes[0], boxes[1]), 1, 0}, {boxes[0], 0, 1}, {boxes[1], 1, 1}};
  }
};

TEST(Metrics, AnEmptyTreeCostsNothing) {
  EXPECT_EQ(sah_cost(Bvh{}), 0);
  EXPECT_EQ(end_point_overlap(Bvh{}, {}), 0);
  EXPECT_EQ(tree_shape(Bvh{}).node_count, 0u);
}

TEST(Metrics, SahCostOfAPair) {
  // Half areas: root 4*1 + 1*1 + 1*4 = 9, leaves 3 each.
  EXPECT_DOUBLE_EQ(sah_cost(Pair(2).bvh), 1 + 3.0 / 9 + 3.0 / 9);
  EXPECT_DOUBLE_EQ(sah_cost(Pair(2).bvh, 2.5), 2.5 + 6.0 / 9);

  // A leaf of both costs two tests.
  Bvh leaf = Pair(2).bvh;
  leaf.nodes = {{leaf.nodes[0].box, 0, 2}};
  EXPECT_DOUBLE_EQ(sah_cost(leaf), 2);
}

TEST(Metrics, SahCostOfHugeTinyAndPointTrees) {
  for (const float scale : {1e-30f, 1e30f}) {
    Bvh bvh = Pair(2).bvh;
    for (BvhNode& node : bvh.nodes) node.box = {node.box.lower * scale, node.box.upper * scale};
    EXPECT_NEAR(sah_cost(bvh), 1 + 6.0 / 9, 1e-6) << scale;
  }
  Bvh points = Pair(2).bvh;
  for (BvhNode& node : points.nodes) node.box = {{1, 1, 1}, {1, 1, 1}};
  EXPECT_EQ(sah_cost(points), 3);
}

TEST(Metrics, EndPointOverlapOfAPair) {
  EXPECT_EQ(end_point_overlap(Pair(0.5f).bvh, Pair(0.5f).boxes), 0);

  // Touching: the shared face lies in the other's leaf, 1 of 6 + 6 for each.
  EXPECT_DOUBLE_EQ(end_point_overlap(Pair(0).bvh, Pair(0).boxes), 2.0 / 12);

  // A quarter deep in each other: one whole face and a quarter of four, for each.
  // The root is a stranger to none.
  EXPECT_DOUBLE_EQ(end_point_overlap(Pair(-0.25f).bvh, Pair(-0.25f).boxes), 2 * (1 + 4 * 0.25) / 12);

  // A flat box has two faces in one place.
  Pair flat(0);
  flat.boxes[1] = flat.bvh.nodes[2].box = {{0.5f, 0, 0}, {0.5f, 1, 1}};
  EXPECT_DOUBLE_EQ(end_point_overlap(flat.bvh, flat.boxes), 2.0 / (6 + 2));
}

TEST(Metrics, EndPointOverlapAgreesWithSampling) {
  // Eight overlapping boxes, four leaves of two, seven nodes.
  Random random(4);
  std::vector<Box3> boxes;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = random.in_box({0, 0, 0}, {2, 2, 2});
    boxes.push_back({corner, corner + random.in_box(splat(0.2f), splat(1.5f))});
  }
  Bvh bvh;
  for (int i = 0; i < 8; ++i) bvh.prim_ids.push_back(PrimId((5 * i) % 8));
  bvh.nodes = {{{}, 1, 0}, {{}, 3, 0}, {{}, 5, 0}, {{}, 0, 2}, {{}, 2, 2}, {{}, 4, 2}, {{}, 6, 2}};
  for (int i = 6; i >= 0; --i) {
    BvhNode& node = bvh.nodes[i];
    if (node.is_leaf())
      for (std::uint32_t k = 0; k < 2; ++k) node.box.extend(boxes[bvh.prim_ids[node.first_index + k].value]);
    else
      node.box = unite(bvh.nodes[node.first_index].box, bvh.nodes[node.first_index + 1].box);
  }

  // Points spread over all faces by area; each counts the nodes around it that it does not belong to.
  const int owner[8][2] = {{3, 1}, {3, 1}, {4, 1}, {4, 1}, {5, 2}, {5, 2}, {6, 2}, {6, 2}};
  double surface = 0, expected = 0;
  for (int position = 0; position < 8; ++position) {
    const Box3& box = boxes[bvh.prim_ids[position].value];
    const Vec3 e = box.extent();
    for (int k = 0; k < 3; ++k) {
      const double area = double(e[(k + 1) % 3]) * e[(k + 2) % 3];
      for (int side = 0; side < 2; ++side) {
        surface += area;
        constexpr int kSamples = 20'000;
        for (int s = 0; s < kSamples; ++s) {
          Vec3 p = random.in_box(box.lower, box.upper);
          p[k] = side ? box.upper[k] : box.lower[k];
          for (int i = 1; i < 7; ++i)
            if (i != owner[position][0] && i != owner[position][1] && bvh.nodes[i].box.contains(p))
              expected += (bvh.nodes[i].is_leaf() ? 2 : 1.5) * area / kSamples;
        }
      }
    }
  }
  EXPECT_NEAR(end_point_overlap(bvh, boxes, 1.5), expected / surface, 0.01 * expected / surface);
}

TEST(Metrics, ShapeOfATree) {
  Bvh bvh = Pair(2).bvh;
  bvh.nodes[2] = {bvh.nodes[2].box, 3, 0};
  bvh.nodes.push_back({bvh.nodes[2].box, 1, 1});
  bvh.nodes.push_back({bvh.nodes[2].box, 2, 3});
  bvh.prim_ids.resize(5);
  const TreeShape shape = tree_shape(bvh);
  EXPECT_EQ(shape.node_count, 5u);
  EXPECT_EQ(shape.leaf_count, 3u);
  EXPECT_EQ(shape.primitive_count, 5u);
  EXPECT_EQ(shape.depth, 2);
  EXPECT_DOUBLE_EQ(shape.mean_leaf_depth, 5.0 / 3);
  EXPECT_EQ(shape.leaves_of_size, (std::vector<std::size_t>{0, 2, 0, 1}));
  EXPECT_DOUBLE_EQ(shape.mean_leaf_size, 5.0 / 3);
  EXPECT_EQ(shape.max_leaf_size, 3u);
  EXPECT_EQ(shape.size_bytes, 5 * 32u + 5 * 4u);
  EXPECT_DOUBLE_EQ(shape.bytes_per_primitive, 36);
}

}  // namespace
}  // namespace boxwood
