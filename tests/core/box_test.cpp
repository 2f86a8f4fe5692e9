// Boxes: what empty means, and measures that neither overflow nor lie.
#include "boxwood/core/box.h"

#include <gtest/gtest.h>

#include "boxwood/core/random.h"

namespace boxwood {
namespace {

TEST(Box, EmptyIsTheNeutralElementOfUnion) {
  const Box3 box{{1, 2, 3}, {4, 5, 6}};
  EXPECT_TRUE(Box3{}.is_empty());
  EXPECT_EQ(unite(Box3{}, box), box);
  EXPECT_EQ(unite(box, Box3{}), box);
  EXPECT_EQ(half_area(Box3{}), 0);
  EXPECT_TRUE(box.contains(Box3{}));
  EXPECT_FALSE(Box3{}.contains(box));
  EXPECT_FALSE(box.overlaps(Box3{}));
  EXPECT_FALSE(Box3{}.contains(Vec3{0, 0, 0}));
}

TEST(Box, ExtendsToHoldPoints) {
  Box3 box;
  box.extend(Vec3{1, -2, 3});
  EXPECT_FALSE(box.is_empty());
  EXPECT_EQ(box.extent(), (Vec3{0, 0, 0}));
  box.extend(Vec3{0, 5, 3});
  EXPECT_EQ(box, (Box3{{0, -2, 3}, {1, 5, 3}}));
}

TEST(Box, BordersBelongToIt) {
  const Box3 box{{0, 0, 0}, {1, 1, 1}};
  for (int which = 0; which < 8; ++which) {
    EXPECT_TRUE(box.contains(box.corner(which)));
    EXPECT_EQ(box.corner(which), (Vec3{float(which & 1), float(which >> 1 & 1), float(which >> 2)}));
  }
  EXPECT_TRUE(box.overlaps({{1, 1, 1}, {2, 2, 2}}));
  EXPECT_FALSE(box.overlaps({{std::nextafter(1.0f, 2.0f), 0, 0}, {2, 1, 1}}));
  EXPECT_FALSE(box.contains(Vec3{0, 0, std::nextafter(1.0f, 2.0f)}));
  EXPECT_FALSE(box.contains(Vec3{0, std::nanf(""), 0}));
}

TEST(Box, IntersectionIsWhatBothContain) {
  Random random(1);
  for (int i = 0; i < 10'000; ++i) {
    const auto some_box = [&] {
      Box3 box;
      box.extend(random.in_box(splat(0), splat(1)));
      box.extend(random.in_box(splat(0), splat(1)));
      return box;
    };
    const Box3 a = some_box(), b = some_box(), both = intersect(a, b);
    const Vec3 p = random.in_box(splat(0), splat(1));
    EXPECT_EQ(both.contains(p), a.contains(p) && b.contains(p));
    EXPECT_EQ(!both.is_empty(), a.overlaps(b));
    EXPECT_TRUE(unite(a, b).contains(a) && unite(a, b).contains(b));
    EXPECT_EQ(a.contains(b), unite(a, b) == a);
  }
}

TEST(Box, MeasuresOfHugeAndTinyBoxesAreFinite) {
  const Box3 huge{splat(-3e38f), splat(3e38f)}, tiny{splat(0), splat(1e-45f)};
  EXPECT_EQ(huge.center(), splat(0));
  EXPECT_TRUE(is_finite(Box3{splat(2e38f), splat(3e38f)}.center()));
  EXPECT_NEAR(half_area(huge) / 3 / 6e38 / 6e38, 1, 1e-6);
  EXPECT_GT(half_area(tiny), 0);
  EXPECT_EQ(half_area({{0, 0, 0}, {2, 3, 0}}), 6);
  EXPECT_EQ(half_area({{0, 0, 0}, {2, 3, 4}}), 26);
}

}  // namespace
}  // namespace boxwood
