// quantized_test.cpp: does a node in half its bytes still hold its children?
#include "boxwood/tree/quantized.h"

#include <cmath>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"

namespace boxwood {
namespace {

/// Boxes within 2^`exponent` of a center that is up to `offset` times as far away; some are flat, some
/// points.
template <int W>
WideNode<W> random_node(Random& random, int exponent, float offset) {
  const Vec3 center = random.in_box(splat(-offset), splat(offset));
  WideNode<W> node;
  const std::uint32_t count = 1 + random.below(W);
  for (std::uint32_t c = 0; c < count; ++c) {
    Vec3 a = center + random.in_box(splat(-1), splat(1)), b = center + random.in_box(splat(-1), splat(1));
    const std::uint32_t kind = random.below(4);
    if (kind == 0) b[static_cast<int>(random.below(3))] = a[0];
    if (kind == 1) b = a;
    for (int k = 0; k < 3; ++k) {
      a[k] = std::ldexp(a[k], exponent);
      b[k] = std::ldexp(b[k], exponent);
    }
    node.set(static_cast<int>(c), {min(a, b), max(a, b)}, ChildRef::leaf(c, 1));
  }
  return node;
}

template <int W>
void expect_held(int exponent, float offset) {
  Random random(static_cast<std::uint64_t>(exponent + 200), W);
  for (int i = 0; i < 2000; ++i) {
    const WideNode<W> node = random_node<W>(random, exponent, offset);
    const QuantizedNode<W> small(node);
    Box3 around;
    for (int c = 0; c < W; ++c)
      if (!node.children[c].is_empty()) around.extend(node.box(c));
    for (int c = 0; c < W; ++c) {
      ASSERT_EQ(small.children[c], node.children[c]);
      if (node.children[c].is_empty()) continue;
      const Box3 was = node.box(c), is = small.box(c);
      for (int k = 0; k < 3; ++k) {
        ASSERT_LE(is.lower[k], was.lower[k]);
        ASSERT_GE(is.upper[k], was.upper[k]);
        // Less than a step outside, but for the rounding of the sum.
        const float rounding =
            4 * 0x1p-24f * std::fmax(std::fabs(around.lower[k]), std::fabs(around.upper[k]));
        ASSERT_LE(was.lower[k] - is.lower[k], small.step[k] + rounding);
        ASSERT_LE(is.upper[k] - was.upper[k], small.step[k] + rounding);
        // The grid is no coarser than it has to be.
        if (around.upper[k] - around.lower[k] > 0x1p-140f && offset == 0) {
          ASSERT_LE(small.step[k] * 127, around.upper[k] - around.lower[k]);
        }
      }
    }
  }
}

TEST(Quantized, HoldsItsChildrenAtAnyScale) {
  for (const int exponent : {-148, -130, -60, 0, 60, 124})
    for (const float offset : {0.0f, 3.0f}) {
      expect_held<4>(exponent, offset);
      expect_held<8>(exponent, offset);
      expect_held<16>(exponent, offset);
    }
  for (const float offset : {1e3f, 1e6f, 1e8f}) {
    expect_held<4>(0, offset);
    expect_held<8>(0, offset);
    expect_held<16>(0, offset);
  }
}

TEST(Quantized, EndsAreExact) {
  WideNode<8> node;
  node.set(0, {{-1, 2, 3}, {1, 2, 1000}}, ChildRef::leaf(0, 1));
  node.set(5, {{0, 2, 3}, {1, 2, 4}}, ChildRef::node(7));
  const QuantizedNode<8> small(node);
  EXPECT_EQ(small.box(0).lower, (Vec3{-1, 2, 3}));
  EXPECT_EQ(small.box(0).upper.y, 2);  // flat stays flat
  EXPECT_EQ(small.box(5).lower.x, 0);  // on the grid
  EXPECT_EQ(small.step[0], 0x1p-6f);   // 2 / 255, up to a power of two
  EXPECT_EQ(small.children[5], ChildRef::node(7));
}

TEST(Quantized, EmptyChildrenAreInsideOut) {
  WideNode<4> node;
  node.set(1, {{0, 0, 0}, {1, 1, 1}}, ChildRef::leaf(0, 2));
  const QuantizedNode<4> small(node);
  for (const int c : {0, 2, 3}) {
    EXPECT_TRUE(small.children[c].is_empty());
    EXPECT_GT(small.box(c).lower.x, small.box(c).upper.x);
  }
  const WideNode<4> wide = small.widen();
  EXPECT_EQ(wide.box(0), Box3{});
  EXPECT_EQ(wide.box(1), small.box(1));
  const QuantizedNode<4> nothing{WideNode<4>{}};
  EXPECT_TRUE(nothing.children[0].is_empty());
}

}  // namespace
}  // namespace boxwood
