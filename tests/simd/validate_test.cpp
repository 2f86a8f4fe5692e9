// Packed trees: what is packed can be unpacked, and each broken invariant is named.
#include "boxwood/simd/validate.h"

#include <cstring>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/core/random.h"
#include "boxwood/tree/collapse.h"
#include "boxwood/tree/validate.h"

namespace boxwood::simd {
namespace {

std::vector<Triangle> random_triangles(std::size_t count) {
  Random random(4);
  std::vector<Triangle> triangles(count);
  for (Triangle& t : triangles) {
    t.a = random.in_box(splat(-1), splat(1));
    t.b = t.a + random.direction() * 0.1f;
    t.c = t.a + random.direction() * 0.1f;
  }
  return triangles;
}

template <int W>
struct Packed {
  explicit Packed(std::size_t count, std::span<const std::uint32_t> keys = {})
      : triangles(random_triangles(count)),
        wide(collapse<W>(build(boxes(triangles)), serial_executor())),
        tree(wide, triangles, keys, serial_executor()) {}

  std::vector<Triangle> triangles;
  WideBvh<W> wide;
  TriangleTree tree;

  // The tree is read-only to everybody else.
  WideNode<W>& node(std::size_t i) { return reinterpret_cast<WideNode<W>*>(pool())[i]; }
  TriangleBlock& block(std::size_t i) {
    return reinterpret_cast<TriangleBlock*>(pool() + tree.node_bytes())[i];
  }
  char* pool() { return const_cast<char*>(tree.pool()); }
};

#define EXPECT_SAYS(tree, words) EXPECT_NE(validate(tree).find(words), std::string::npos) << validate(tree)

template <class Width>
class ValidatePacked : public ::testing::Test {};
using Widths = ::testing::Types<std::integral_constant<int, 4>, std::integral_constant<int, 8>,
                                std::integral_constant<int, 16>>;
TYPED_TEST_SUITE(ValidatePacked, Widths);

TYPED_TEST(ValidatePacked, UnpackingGivesBackWhatWasPacked) {
  constexpr int W = TypeParam::value;
  for (const std::size_t count : {0, 1, 4, 5, 13, 1000}) {
    const Packed<W> packed(count);
    EXPECT_EQ(validate(packed.tree), "");
    const WideBvh<W> again = packed.tree.template unpack<W>();
    EXPECT_EQ(again.box, packed.wide.box);
    EXPECT_EQ(again.slots, packed.wide.slots);
    ASSERT_EQ(again.nodes.size(), packed.wide.nodes.size());
    for (std::size_t i = 0; i < again.nodes.size(); ++i) {
      const WideNode<W>&a = again.nodes[i], &b = packed.wide.nodes[i];
      EXPECT_EQ(std::memcmp(a.planes, b.planes, sizeof a.planes), 0);
      EXPECT_EQ(std::memcmp(a.children, b.children, sizeof a.children), 0);
    }
    EXPECT_EQ(boxwood::validate(again, boxes(packed.triangles)), "");
    EXPECT_EQ(packed.tree.size_bytes(), again.nodes.size() * sizeof(WideNode<W>) + again.slots.size() * 40);
  }
}

TYPED_TEST(ValidatePacked, KeysMayHaveGaps) {
  std::vector<std::uint32_t> keys;
  for (std::uint32_t i = 0; i < 50; ++i) keys.push_back(0xfffffff0u - 7000 * i);
  const Packed<TypeParam::value> packed(50, keys);
  EXPECT_EQ(validate(packed.tree), "");
  for (std::size_t i = 0; i < packed.tree.block_count(); ++i) {
    const TriangleBlock block = packed.tree.block(i);
    for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
      const std::uint32_t number = (0xfffffff0u - block.key[lane]) / 7000;
      const Triangle found = block.triangle(lane), expected = packed.triangles.at(number);
      EXPECT_TRUE(found.a == expected.a && found.b == expected.b && found.c == expected.c);
    }
  }
}

TYPED_TEST(ValidatePacked, SaysWhatIsBroken) {
  constexpr int W = TypeParam::value;
  const auto make = [] { return Packed<W>(1000); };
  const auto first_leaf = [](Packed<W>& p, std::size_t& node, int& child) {
    for (node = 0; node < p.tree.node_count(); ++node)
      for (child = 0; child < W; ++child) {
        const ChildRef ref = p.node(node).children[child];
        if (ref.is_leaf() && !ref.is_empty()) return;
      }
  };
  std::size_t node = 0;
  int child = 0;

  Packed<W> p = make();
  first_leaf(p, node, child);
  p.node(node).children[child].bits += 1 << 4;  // into the middle of a block
  EXPECT_SAYS(p.tree, "is a leaf with block 268435455");

  p = make();
  first_leaf(p, node, child);
  p.node(node).children[child] = ChildRef::leaf(0, 1);  // into the nodes
  EXPECT_SAYS(p.tree, "is a leaf with block 268435455");

  p = make();
  p.block(0).v[1][2][0] = 17;  // out of its box, or no longer what fills the block
  EXPECT_NE(validate(p.tree), "");

  // A lane that fills its block has another triangle than the first.
  p = make();
  for (std::size_t b = 0; b < p.tree.block_count(); ++b) {
    if (!is_padding(p.block(b).key, 3)) continue;
    p.block(b).v[0][0][3] += 1e-6f;
    EXPECT_SAYS(p.tree, "lane 3 of block " + std::to_string(b) + " has key");
    break;
  }

  p = make();
  first_leaf(p, node, child);
  p.node(node).set(child, {p.tree.box().lower, p.tree.box().lower}, p.node(node).children[child]);
  EXPECT_NE(validate(p.tree), "");
}

}  // namespace
}  // namespace boxwood::simd
