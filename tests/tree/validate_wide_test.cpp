// A wide tree that is fine passes; each broken invariant is named; garbage is survived.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/tree/collapse.h"
#include "boxwood/tree/validate.h"
#include "support/random_tree.h"

namespace boxwood {
namespace {

/// Unit cubes along x. Node 0: node 1, a leaf of block 0 {4, 5}, then empty. Node 1: a leaf of blocks 1 and 2
/// {0, 1, 2, 3, 6}, and one of block 3 {7}.
template <int W>
struct Sample {
  std::vector<Box3> boxes;
  WideBvh<W> wide;

  Sample() {
    for (int i = 0; i < 8; ++i) boxes.push_back({{float(i), 0, 0}, {float(i) + 1, 1, 1}});
    wide.box = {{0, 0, 0}, {8, 1, 1}};
    for (const int prim : {4, 5, 4, 4, 0, 1, 2, 3, 6, 6, 6, 6, 7, 7, 7, 7})
      wide.slots.push_back(PrimId(prim));
    wide.nodes.resize(2);
    wide.nodes[0].set(0, {{0, 0, 0}, {8, 1, 1}}, ChildRef::node(1));
    wide.nodes[0].set(1, {{4, 0, 0}, {6, 1, 1}}, ChildRef::leaf(0, 1));
    wide.nodes[1].set(0, {{0, 0, 0}, {7, 1, 1}}, ChildRef::leaf(1, 2));
    wide.nodes[1].set(2, boxes[7], ChildRef::leaf(3, 1));
  }
  std::string verdict() const { return validate(wide, boxes); }
};

#define EXPECT_SAYS(sample, words) \
  EXPECT_NE((sample).verdict().find(words), std::string::npos) << (sample).verdict()

template <class Width>
class ValidateWide : public ::testing::Test {};
using Widths = ::testing::Types<std::integral_constant<int, 4>, std::integral_constant<int, 8>,
                                std::integral_constant<int, 16>>;
TYPED_TEST_SUITE(ValidateWide, Widths);

TYPED_TEST(ValidateWide, AcceptsATreeAndNoTree) {
  EXPECT_EQ(Sample<TypeParam::value>().verdict(), "");
  EXPECT_EQ(validate(WideBvh<TypeParam::value>{}, {}), "");
  EXPECT_EQ(validate(WideBvh<TypeParam::value>{}, std::vector<Box3>(3)), "");  // nothing but empty boxes
}

TYPED_TEST(ValidateWide, AcceptsWhatCollapseMakes) {
  constexpr int W = TypeParam::value;
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<Box3> boxes;
    for (std::uint32_t i = random.below(60); i-- > 0;) {
      const Vec3 corner = random.in_box({0, 0, 0}, {1, 1, 1});
      boxes.push_back({corner, corner + random.in_box(splat(0), splat(0.3f))});
    }
    const auto leaf_size = 1 + static_cast<std::uint32_t>(round) % 40;
    const WideBvh<W> wide = collapse<W>(
        test::random_tree(boxes, leaf_size, static_cast<std::uint64_t>(round)), serial_executor());
    ASSERT_EQ(validate(wide, boxes), "");
  }
}

TYPED_TEST(ValidateWide, SaysWhenSizesDoNotMatch) {
  Sample<TypeParam::value> s;
  s.wide.slots.pop_back();
  EXPECT_SAYS(s, "there are 15 slots, expected whole blocks of 4");
  s = {};
  s.wide.nodes.clear();
  EXPECT_SAYS(s, "no nodes for 8 primitives");
}

TYPED_TEST(ValidateWide, SaysWhereAReferenceLeadsNowhere) {
  for (const std::uint32_t index : {0u, 2u, 0xfffffffu}) {
    Sample<TypeParam::value> s;
    s.wide.nodes[0].children[0] = ChildRef::node(index);
    EXPECT_SAYS(s, "child 0 of node 0 is node " + std::to_string(index));
  }
  Sample<TypeParam::value> s;
  s.wide.nodes[1].children[2] = ChildRef::node(1);  // a cycle
  EXPECT_SAYS(s, "child 2 of node 1 is node 1, expected one behind its parent");
  s = {};
  s.wide.nodes[1].children[2] = ChildRef::leaf(3, 2);
  EXPECT_SAYS(s, "child 2 of node 1 is a leaf with block 4 of 4");
  s = {};
  s.wide.nodes[0].children[0].bits |= 2;
  EXPECT_SAYS(s, "child 0 of node 0 has a reference that is neither a node nor a leaf");
}

TYPED_TEST(ValidateWide, SaysWhatHasTwoParentsOrNone) {
  Sample<TypeParam::value> s;
  s.wide.nodes[0].set(3, s.wide.box, ChildRef::node(1));
  EXPECT_SAYS(s, "node 1 has two parents; one is node 0");
  s = {};
  s.wide.nodes.emplace_back();
  EXPECT_SAYS(s, "node 2 has no parent");
  s = {};
  s.wide.nodes[1].children[2] = ChildRef::leaf(2, 1);
  EXPECT_SAYS(s, "child 2 of node 1 is a leaf with block 2, as another is");
  s = {};
  s.wide.nodes[1].children[0] = ChildRef::leaf(1, 1);
  EXPECT_SAYS(s, "no leaf owns block 2");
}

TYPED_TEST(ValidateWide, SaysWhenAnEmptyChildHasABox) {
  Sample<TypeParam::value> s;
  s.wide.nodes[1].set(1, s.boxes[0], ChildRef{});
  EXPECT_SAYS(s, "child 1 of node 1 is empty, but its box is not");
  s.wide.nodes[1].set(1, Box3{}, ChildRef{});
  EXPECT_EQ(s.verdict(), "");
  s.wide.nodes[1].planes[2][0][1] = std::nanf("");
  EXPECT_SAYS(s, "child 1 of node 1 is empty, but its box is not");
}

TYPED_TEST(ValidateWide, SaysWhenABoxDoesNotHoldWhatIsBelow) {
  for (int side = 0; side < 6; ++side) {
    const auto shrink = [side](Box3 box) {
      float& plane = side < 3 ? box.lower[side] : box.upper[side - 3];
      plane = std::nextafter(plane, side < 3 ? kInfinity : -kInfinity);
      return box;
    };
    Sample<TypeParam::value> s;
    s.wide.box = shrink(s.wide.box);
    EXPECT_SAYS(s, "child 0 of node 0 has a box that the box of its node does not hold");
    s = {};
    s.wide.nodes[0].set(0, shrink(s.wide.nodes[0].box(0)), ChildRef::node(1));
    EXPECT_SAYS(s, "of node 1 has a box that the box of its node does not hold");
    s = {};
    s.wide.nodes[0].set(1, shrink(s.wide.nodes[0].box(1)), ChildRef::leaf(0, 1));
    EXPECT_SAYS(s, "reaches out of the leaves that it stands in");
  }
  Sample<TypeParam::value> s;
  s.wide.nodes[0].planes[1][0][0] = std::nanf("");
  EXPECT_SAYS(s, "child 0 of node 0 has a box");
  s = {};
  s.wide.nodes[1].set(2, Box3{}, ChildRef::leaf(3, 1));
  EXPECT_SAYS(s, "child 2 of node 1 has a box");
}

TYPED_TEST(ValidateWide, SaysWhichPrimitiveIsOutOfPlace) {
  Sample<TypeParam::value> s;
  s.wide.slots[13] = PrimId(8);
  EXPECT_SAYS(s, "block 3 names primitive 8, but there are 8");
  s = {};
  s.boxes.pop_back();
  EXPECT_SAYS(s, "block 3 names primitive 7, but there are 7");
  s = {};
  for (int k = 12; k < 16; ++k) s.wide.slots[k] = PrimId(0);
  EXPECT_SAYS(s, "child 2 of node 1 is a leaf whose box does not touch primitive 0");
  s = {};
  s.wide.slots[1] = PrimId(4);
  EXPECT_SAYS(s, "no leaf holds primitive 5");
  s = {};
  s.wide.slots[9] = PrimId(2);
  EXPECT_SAYS(s, "block 2 names primitive 2, which stands in its leaf already");
}

TYPED_TEST(ValidateWide, APrimitiveMayStandInSeveralLeavesThatCoverIt) {
  // Primitive 5 grows into the place of 7 and is cut in two.
  Sample<TypeParam::value> s;
  s.boxes[5].upper.x = 8;
  EXPECT_SAYS(s, "the box of primitive 5 reaches out");
  s.wide.slots[13] = PrimId(5);
  EXPECT_SAYS(s, "block 3 names primitive 5, which stands in another leaf, but the tree has no parts");
  s.wide.has_parts = true;
  EXPECT_EQ(s.verdict(), "");
}

TYPED_TEST(ValidateWide, SaysWhenATreeIsTooDeep) {
  constexpr int W = TypeParam::value;
  const Box3 box{{0, 0, 0}, {1, 1, 1}};
  for (const int depth : {kMaxWideDepth, kMaxWideDepth + 1}) {
    WideBvh<W> wide;
    wide.box = box;
    wide.nodes.resize(static_cast<std::size_t>(depth) + 1);
    for (int i = 0; i < depth; ++i)
      wide.nodes[static_cast<std::size_t>(i)].set(0, box, ChildRef::node(static_cast<std::uint32_t>(i) + 1));
    wide.nodes.back().set(0, box, ChildRef::leaf(0, 1));
    wide.slots.assign(kBlockWidth, PrimId(0));
    const std::string verdict = validate(wide, std::vector<Box3>{box});
    EXPECT_EQ(verdict, depth == kMaxWideDepth ? "" : "node 113 lies at depth 113, deeper than 112");
  }
}

TYPED_TEST(ValidateWide, SurvivesGarbage) {
  Random random(9);
  for (int round = 0; round < 5'000; ++round) {
    // Break a few words of a good tree, or all of them.
    Sample<TypeParam::value> s;
    const std::size_t words = s.wide.nodes.size() * sizeof(s.wide.nodes[0]) / 4;
    const bool all = round % 4 == 0;
    for (std::size_t k = 0; k < (all ? words : 1 + random.below(3)); ++k) {
      const std::uint32_t value = random.below(2) ? random.next() : random.below(64);
      auto* bytes = reinterpret_cast<unsigned char*>(s.wide.nodes.data());
      std::memcpy(bytes + 4 * (all ? k : random.below(static_cast<std::uint32_t>(words))), &value, 4);
    }
    if (random.below(4) == 0) s.wide.slots[random.below(16)] = PrimId(random.next());
    const std::string verdict = s.verdict();
    EXPECT_TRUE(!all || !verdict.empty());
  }
}

}  // namespace
}  // namespace boxwood
