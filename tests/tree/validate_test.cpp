// A tree that is fine passes; each broken invariant is named; garbage is survived.
#include "boxwood/tree/validate.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"

namespace boxwood {
namespace {

/// Root 0, leaf 1 {2}, interior 2, leaves 3 {0, 1} and 4 {3}; unit cubes along x.
struct Sample {
  std::vector<Box3> boxes;
  Bvh bvh;

  Sample() {
    for (int i = 0; i < 4; ++i) boxes.push_back({{float(i), 0, 0}, {float(i) + 1, 1, 1}});
    bvh.prim_ids = {PrimId(2), PrimId(0), PrimId(1), PrimId(3)};
    bvh.nodes = {{{{0, 0, 0}, {4, 1, 1}}, 1, 0},
                 {boxes[2], 0, 1},
                 {{{0, 0, 0}, {4, 1, 1}}, 3, 0},
                 {{{0, 0, 0}, {2, 1, 1}}, 1, 2},
                 {boxes[3], 3, 1}};
  }
  std::string verdict() const { return validate(bvh, boxes); }
};

#define EXPECT_SAYS(sample, words) \
  EXPECT_NE((sample).verdict().find(words), std::string::npos) << (sample).verdict()

TEST(Validate, AcceptsATreeAndNoTree) {
  EXPECT_EQ(Sample().verdict(), "");
  EXPECT_EQ(validate(Bvh{}, {}), "");
}

TEST(Validate, SaysWhenSizesDoNotMatch) {
  Sample s;
  s.boxes.pop_back();
  EXPECT_SAYS(s, "prim_ids has 4 entries for 3 primitives");
  s = Sample();
  s.bvh.nodes.clear();
  EXPECT_SAYS(s, "0 nodes for 4 primitives");
  s.bvh.prim_ids.clear();
  s.boxes.clear();
  s.bvh.nodes.resize(1);
  EXPECT_SAYS(s, "1 nodes for 0 primitives");
}

TEST(Validate, SaysWhenChildrenDoNotFollowTheirParent) {
  for (const std::uint32_t first : {0u, 1u, 2u}) {
    Sample s;
    s.bvh.nodes[2].first_index = first;  // itself among them: a cycle
    EXPECT_SAYS(s, "node 2 has its children at " + std::to_string(first) + ", not after itself");
  }
}

TEST(Validate, SaysWhenChildrenAreOutOfRange) {
  for (const std::uint32_t first : {4u, 5u, 0xffffffffu}) {
    Sample s;
    s.bvh.nodes[2].first_index = first;
    EXPECT_SAYS(s, "node 2 has its children at " + std::to_string(first));
    EXPECT_SAYS(s, "of 5 nodes");
  }
}

TEST(Validate, SaysWhenALeafOwnsWhatDoesNotExist) {
  Sample s;
  s.bvh.nodes[4].count = 2;
  EXPECT_SAYS(s, "node 4 is a leaf that owns positions 3 to 4");
  s.bvh.nodes[4] = {s.boxes[3], 0xffffffffu, 0xffffffffu};
  EXPECT_SAYS(s, "node 4 is a leaf that owns positions 4294967295");
}

TEST(Validate, SaysWhenANodeHasTwoParentsOrNone) {
  Sample s;
  s.bvh.nodes[1] = {s.bvh.nodes[2].box, 3, 0};
  EXPECT_SAYS(s, "node 3 has two parents; one is node 2");
  s = Sample();
  s.bvh.nodes.push_back({s.boxes[3], 3, 1});
  EXPECT_SAYS(s, "node 5 has no parent");
}

TEST(Validate, SaysWhenAPositionHasTwoLeavesOrNone) {
  Sample s;
  s.bvh.nodes[4].first_index = 2;
  EXPECT_SAYS(s, "node 4 is a leaf that owns position 2 of prim_ids, as another does");
  s = Sample();
  s.bvh.nodes[3].count = 1;
  EXPECT_SAYS(s, "no leaf owns position 2");
}

TEST(Validate, SaysWhenPrimIdsAreNoPermutation) {
  Sample s;
  s.bvh.prim_ids[1] = PrimId(4);
  EXPECT_SAYS(s, "position 1 of prim_ids names primitive 4, but there are 4");
  s.bvh.prim_ids[1] = PrimId();
  EXPECT_SAYS(s, "position 1 of prim_ids");
  s.bvh.prim_ids[1] = PrimId(2);
  EXPECT_SAYS(s, "position 1 of prim_ids names primitive 2 a second time");
}

TEST(Validate, SaysWhenABoxDoesNotHoldWhatIsBelow) {
  for (int side = 0; side < 6; ++side)
    for (const std::uint32_t node : {0u, 3u}) {
      Sample s;
      float& plane = side < 3 ? s.bvh.nodes[node].box.lower[side] : s.bvh.nodes[node].box.upper[side - 3];
      plane = side < 3 ? std::nextafter(plane, kInfinity) : std::nextafter(plane, -kInfinity);
      EXPECT_SAYS(s, node == 0 ? "node 0 has a box that does not hold the box of its child, node"
                               : "node 3 is a leaf with a box that does not hold the box of primitive");
    }
  Sample s;
  s.bvh.nodes[0].box.lower.y = std::nanf("");
  EXPECT_SAYS(s, "node 0 has a box");
  s = Sample();
  s.bvh.nodes[1].box = Box3{};
  EXPECT_SAYS(s, "node 1 is a leaf with a box");
}

TEST(Validate, AnEmptyPrimitiveFitsAnywhere) {
  Sample s;
  s.boxes[2] = Box3{};
  s.bvh.nodes[1].box = Box3{};
  EXPECT_EQ(s.verdict(), "");
}

TEST(Validate, SaysWhenATreeIsTooDeep) {
  // A chain: each interior node has a leaf on its left and the rest on its right.
  for (const int depth : {kMaxDepth, kMaxDepth + 1}) {
    Bvh bvh;
    const Box3 box{{0, 0, 0}, {1, 1, 1}};
    const std::vector<Box3> boxes(depth + 1, box);
    for (int i = 0; i <= depth; ++i) bvh.prim_ids.push_back(PrimId(i));
    bvh.nodes.push_back({box, 1, 0});
    for (int i = 0; i < depth; ++i) {
      bvh.nodes.push_back({box, std::uint32_t(i), 1});
      bvh.nodes.push_back({box, std::uint32_t(2 * i + 3), 0});
    }
    bvh.nodes.back() = {box, std::uint32_t(depth), 1};
    const std::string verdict = validate(bvh, boxes);
    if (depth == kMaxDepth) {
      EXPECT_EQ(verdict, "");
    } else {
      EXPECT_NE(verdict.find("lies at depth 97, deeper than 96"), std::string::npos) << verdict;
    }
  }
}

TEST(Validate, PartsOfPrimitivesMayRepeat) {
  // Primitive 0 stands in both leaves.
  Bvh bvh;
  bvh.prim_ids = {PrimId(0), PrimId(1), PrimId(0)};
  bvh.nodes = {
      {{{0, 0, 0}, {4, 1, 1}}, 1, 0}, {{{0, 0, 0}, {2, 1, 1}}, 0, 2}, {{{2, 0, 0}, {4, 1, 1}}, 2, 1}};
  std::vector<Box3> boxes{{{0, 0, 0}, {4, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}};
  EXPECT_NE(validate(bvh, boxes), "");
  EXPECT_EQ(validate(bvh, boxes, Repeats::allowed), "");

  boxes[0].upper.x = 5;
  EXPECT_EQ(validate(bvh, boxes, Repeats::allowed),
            "the leaves of primitive 0 do not reach as far as its box");
  boxes[0].upper.x = 4;
  bvh.prim_ids[1] = PrimId(0);
  EXPECT_EQ(validate(bvh, boxes, Repeats::allowed), "node 1 is a leaf with primitive 0 twice");
  bvh.prim_ids[0] = PrimId(2);
  EXPECT_EQ(validate(bvh, boxes, Repeats::allowed),
            "position 0 of prim_ids names primitive 2, but there are 2");
  bvh.prim_ids = {PrimId(0), PrimId(0), PrimId(0)};
  bvh.nodes[1].count = 1;
  EXPECT_EQ(validate(bvh, boxes, Repeats::allowed), "no leaf owns position 1 of prim_ids");
}

TEST(Validate, SurvivesGarbage) {
  Random random(9);
  for (int round = 0; round < 20'000; ++round) {
    // Break a few words of a good tree, or all of them.
    Sample s;
    const std::size_t words = s.bvh.nodes.size() * sizeof(BvhNode) / 4;
    const bool all = round % 4 == 0;
    for (std::size_t k = 0; k < (all ? words : 1 + random.below(3)); ++k) {
      const std::uint32_t value = random.below(2) ? random.next() : random.below(8);
      auto* bytes = reinterpret_cast<unsigned char*>(s.bvh.nodes.data());
      std::memcpy(bytes + 4 * (all ? k : random.below(words)), &value, 4);
    }
    if (random.below(4) == 0) s.bvh.prim_ids[random.below(4)] = PrimId(random.next());
    const std::string verdict = s.verdict();
    EXPECT_TRUE(!all || !verdict.empty());
  }
}

}  // namespace
}  // namespace boxwood
