#include "boxwood/core/box.h"

#include <gtest/gtest.h>

namespace boxwood {
namespace {

TEST(Box, EmptyIsTheNeutralElementOfUnion) {
  const Box3 box{{1, 2, 3}, {4, 5, 6}};
  EXPECT_TRUE(Box3{}.is_empty());
  EXPECT_EQ(unite(Box3{}, box), box);
  EXPECT_EQ(half_area(Box3{}), 0);
}

}  // namespace
}  // namespace boxwood
