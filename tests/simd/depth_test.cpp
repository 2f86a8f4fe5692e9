// depth_test.cpp: is there room on the stacks for the deepest tree that collapse makes?
//
// A binary leaf at kMaxDepth may hold any number of primitives, and a wide tree puts further levels below it.
// Here every level above leaves as much behind as it can, and the rays that are asked enter every box.
#include <algorithm>
#include <memory>
#include <numeric>
#include <stdexcept>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/query/traverse_wide.h"
#include "boxwood/tree/collapse.h"
#include "boxwood/tree/validate.h"
#include "kernel_oracle.h"

namespace boxwood::simd {
namespace {

constexpr std::uint32_t kCrowd = 1 << 18;

/// Boxes around the x axis and triangles beside it, but for one in the middle of the crowd.
struct DeepTree {
  std::vector<Triangle> triangles;
  Bvh bvh;

  /// The path to the crowd is the first child of each node, or the last; its boxes become a little smaller
  /// from level to level, so that the collapse opens all else before them.
  DeepTree(int width, bool path_is_first) {
    bvh.nodes.resize(1);
    float size = 1;
    std::uint32_t current = 0;
    for (int depth = 0; depth < kMaxDepth; ++depth) {
      const std::uint32_t pair = split(current, size);
      current = path_is_first ? pair : pair + 1;
      fill(path_is_first ? pair + 1 : pair, size,
           std::min(width - 1, 1 << std::min(4, kMaxDepth - 1 - depth)));
      size *= 0.99f;
    }
    make_leaf(current, size, kCrowd);
    triangles[triangles.size() - kCrowd / 2] = {{0.5f, -0.3f, -0.1f}, {0.5f, 0, 0.3f}, {0.5f, 0.1f, -0.1f}};
  }

 private:
  static Box3 box(float size) { return {{0, -size, -size}, {1, size, size}}; }
  std::uint32_t split(std::uint32_t i, float size) {
    const auto pair = static_cast<std::uint32_t>(bvh.nodes.size());
    bvh.nodes[i] = {box(size), pair, 0};
    bvh.nodes.resize(pair + 2);
    return pair;
  }
  /// A subtree of `leaves` leaves, so large that no two become one.
  void fill(std::uint32_t i, float size, int leaves) {
    if (leaves == 1) return make_leaf(i, size, 7);
    const std::uint32_t pair = split(i, size);
    fill(pair, size, leaves / 2);
    fill(pair + 1, size, leaves - leaves / 2);
  }
  void make_leaf(std::uint32_t i, float size, std::uint32_t count) {
    bvh.nodes[i] = {box(size), static_cast<std::uint32_t>(bvh.prim_ids.size()), count};
    for (std::uint32_t k = 0; k < count; ++k) {
      bvh.prim_ids.push_back(PrimId(triangles.size()));
      triangles.push_back({{0, 0.3f, 0.3f}, {1, 0.3f, 0.3f}, {1, 0.3f, 0.2f}});
    }
  }
};

std::vector<Ray> rays_along_x() {
  std::vector<Ray> rays;
  for (int i = 0; i < 20; ++i)  // neighbours, for the bundles
    rays.push_back({{-1, 0.001f * float(i), 0.002f * float(i % 8)}, 0, {1, 0, 0}, kInfinity});
  return rays;
}

struct LeafCounter {
  const PreparedRay& ray;
  std::size_t blocks = 0;
  float bound(const Box3& box) const { return ray.bound(box); }
  float limit() const { return kInfinity; }
  void visit(ChildRef leaf) { blocks += leaf.blocks(); }
};

template <int W>
void expect_room(bool path_is_first) {
  SCOPED_TRACE(testing::Message() << W << " children, path is the " << (path_is_first ? "first" : "last"));
  const DeepTree deep(W, path_is_first);
  ASSERT_EQ(validate(deep.bvh, boxes(deep.triangles)), "");
  const WideBvh<W> wide = collapse<W>(deep.bvh, serial_executor());
  ASSERT_EQ(validate(wide, boxes(deep.triangles)), "");
  const TriangleTree tree(wide, deep.triangles, {}, serial_executor());
  // The last levels of the path become one: four of sixteen children, three of eight, two of four; and the
  // crowd takes four of sixteen, five of eight, eight of four.
  EXPECT_EQ(tree.max_stack(), (kMaxDepth + (W == 16 ? 0 : W == 8 ? 2 : 6)) * (W - 1) + W);

  // Plain C++ comes past every block.
  const std::vector<Ray> rays = rays_along_x();
  const PreparedRay prepared(rays[0], wide.box);
  LeafCounter counter{prepared};
  NoStatistics none;
  traverse_wide<W>(
      [&](ChildRef node) -> const auto& { return tree.full_node<W>(node); }, counter, none);
  EXPECT_EQ(counter.blocks, tree.block_count());

  // So does every kernel.
  const std::vector<test::Answer> answers = test::brute_answers(deep.triangles, {}, rays);
  const Passage everything{{-kInfinity, kInfinity}, 0};
  for (const Kernels* kernels : available_kernels()) {
    if (kernels->width != W) continue;
    const test::Checked checked = test::expect_equal_to(*kernels, tree, rays, wide.box, answers);
    EXPECT_EQ(checked.hits, rays.size());
    std::vector<TriangleHit> hits;
    ASSERT_TRUE(kernels->placed_all_hits(tree, rays[0], wide.box, everything, kInfinity, hits));
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_EQ(hits[0].key, deep.triangles.size() - kCrowd / 2);

    // And when it goes below a placement by itself, where so deep a tree is walked ray by ray also in a
    // batch.
    const Box3 world_box[] = {wide.box};
    const Bvh top = build(world_box);
    const PlacedTrees trees(
        BoxTree(collapse<W>(top, serial_executor()), world_box),
        {{Affine3::identity(), wide.box, wide.box, &tree, tree.pool(), tree.box_slack(), 0, 0}});
    std::vector<std::uint32_t> order(rays.size()), unusual;
    std::iota(order.begin(), order.end(), 0u);
    const std::unique_ptr<bool[]> are_hit(new bool[rays.size()]);
    std::vector<PlacedHit> found(rays.size(), PlacedHit{{kInfinity}});
    kernels->closest_hits_below(trees, rays, wide.box, order, found.data(), nullptr, unusual);
    kernels->any_hits_below(trees, rays, wide.box, order, are_hit.get(), unusual);
    EXPECT_EQ(unusual.size(), 0u);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(found[i].key, answers[i].crossings[0].second);
      EXPECT_TRUE(are_hit[i]);
    }
  }
}

TEST(KernelDepth, ACrowdInTheDeepestLeaf) {
  for (const bool path_is_first : {true, false}) {
    expect_room<4>(path_is_first);
    expect_room<8>(path_is_first);
    expect_room<16>(path_is_first);
  }
}

/// A chain of `levels` nodes that hold one primitive each, and whatever is below, W times for the last.
template <int W>
WideBvh<W> chain(int levels) {
  const Box3 box{{0, 0, 0}, {1, 1, 1}};
  WideBvh<W> wide;
  wide.box = box;
  wide.nodes.resize(static_cast<std::size_t>(levels));
  std::uint32_t block = 0;
  for (int level = 0; level < levels; ++level) {
    WideNode<W>& node = wide.nodes[static_cast<std::size_t>(level)];
    const bool is_last = level == levels - 1;
    if (!is_last) node.set(0, box, ChildRef::node(static_cast<std::uint32_t>(level + 1)));
    for (int c = is_last ? 0 : 1; c < W; ++c) node.set(c, box, ChildRef::leaf(block++, 1));
  }
  wide.slots.resize(std::size_t(block) * kBlockWidth, PrimId(0));
  return wide;
}

template <int W>
void expect_refused_when_deeper() {
  const std::vector<Triangle> triangles{{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}}};
  const auto pack = [&](int levels) {
    return TriangleTree(chain<W>(levels), triangles, {}, serial_executor()).max_stack();
  };
  EXPECT_EQ(pack(kMaxWideDepth + 1), kMaxWideStack<W>);
  EXPECT_THROW(pack(kMaxWideDepth + 2), std::length_error);
}

/// A path of nodes beside which stands at each level what leaves most behind where two nodes are taken at a
/// time: W - 1 nodes, of W nodes of one leaf each.
template <int W>
WideBvh<W> hedge() {
  const Box3 box{{0, 0, 0}, {1, 1, 1}};
  WideBvh<W> wide;
  wide.box = box;
  std::uint32_t block = 0;
  const auto add = [&] {
    wide.nodes.emplace_back();
    return static_cast<std::uint32_t>(wide.nodes.size() - 1);
  };
  std::uint32_t path = add();
  for (int depth = 0; depth < kMaxWideDepth - 2; ++depth) {
    for (int c = 0; c < W; ++c) {
      const std::uint32_t child = add();
      wide.nodes[path].set(c, box, ChildRef::node(child));
      for (int k = 0; c < W - 1 && k < W; ++k) {
        const std::uint32_t twig = add();
        wide.nodes[child].set(k, box, ChildRef::node(twig));
        wide.nodes[twig].set(0, box, ChildRef::leaf(block++, 1));
      }
    }
    path = static_cast<std::uint32_t>(wide.nodes.size() - 1);
  }
  wide.nodes[path].set(0, box, ChildRef::leaf(block++, 1));
  wide.slots.resize(std::size_t(block) * kBlockWidth, PrimId(0));
  return wide;
}

template <int W>
void expect_room_for_two_at_a_time() {
  const std::vector<Triangle> triangles{{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}}};
  const WideBvh<W> wide = hedge<W>();
  const TriangleTree tree(wide, triangles, {}, serial_executor());
  const Ray hit{{0.5f, -1, 0.2f}, 0, {0, 1, 0.01f}, kInfinity},
      miss{{0.2f, -1, 0.5f}, 0, {0, 1, 0.01f}, kInfinity};
  for (const Kernels* kernels : available_kernels()) {
    if (kernels->width != W) continue;
    std::vector<TriangleHit> hits;
    bool is_hit = true;
    ASSERT_TRUE(kernels->all_hits(tree, hit, wide.box, hits));
    ASSERT_TRUE(kernels->any_hit(tree, miss, wide.box, is_hit));
    EXPECT_EQ(hits.size(), tree.block_count());  // once for each block
    EXPECT_FALSE(is_hit);
  }
}

TEST(KernelDepth, RoomForTwoAtATime) {
  expect_room_for_two_at_a_time<4>();
  expect_room_for_two_at_a_time<8>();
  expect_room_for_two_at_a_time<16>();
}

TEST(KernelDepth, DeeperTreesAreRefused) {
  expect_refused_when_deeper<4>();
  expect_refused_when_deeper<8>();
  expect_refused_when_deeper<16>();
}

}  // namespace
}  // namespace boxwood::simd
