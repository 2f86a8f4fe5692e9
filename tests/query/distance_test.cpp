// The bound that point queries lean on: a box is never farther than a box inside it.
#include "boxwood/query/distance.h"

#include <gtest/gtest.h>

#include "boxwood/core/random.h"

namespace boxwood {
namespace {

TEST(Distance, IsNeverLargerForABoxThanForABoxInsideIt) {
  Random random(2);
  for (int i = 0; i < 100'000; ++i) {
    Box3 inner;
    inner.extend(random.in_box(splat(-1), splat(1)));
    inner.extend(random.in_box(splat(-1), splat(1)));
    Box3 outer = inner;
    outer.extend(random.in_box(splat(-2), splat(2)));
    const Vec3 p = random.in_box(splat(-3), splat(3));
    EXPECT_LE(distance(outer, p), distance(inner, p));
    EXPECT_EQ(distance(inner, p) == 0, inner.contains(p));
  }
  EXPECT_EQ(distance(Box3{{0, 0, 0}, {1, 1, 1}}, {2, 0.5f, -2}), std::sqrt(5.0f));
  EXPECT_EQ(distance(Box3{}, {0, 0, 0}), kInfinity);
}

}  // namespace
}  // namespace boxwood
