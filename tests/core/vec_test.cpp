// Vectors: fixed operations, and selects that are defined for NaN and -0.
#include "boxwood/core/vec.h"

#include <gtest/gtest.h>

#include "boxwood/core/id.h"
#include "boxwood/core/random.h"

namespace boxwood {
namespace {

TEST(Vec, Arithmetic) {
  const Vec3 a{1, 2, 3}, b{4, -5, 6};
  EXPECT_EQ(a + b, (Vec3{5, -3, 9}));
  EXPECT_EQ(a - b, (Vec3{-3, 7, -3}));
  EXPECT_EQ(a * b, (Vec3{4, -10, 18}));
  EXPECT_EQ(b / a, (Vec3{4, -2.5f, 2}));
  EXPECT_EQ(2 * a, a * 2);
  EXPECT_EQ(-a, (Vec3{-1, -2, -3}));
  EXPECT_EQ(dot(a, b), 12);
  EXPECT_EQ(cross(a, b), (Vec3{27, 6, -13}));
  EXPECT_EQ(length({2, 3, 6}), 7);
  EXPECT_EQ(normalize({0, 3, 4}), (Vec3{0, 0.6f, 0.8f}));
  Vec3 c = a;
  c += b, c -= {1, 1, 1}, c *= Vec3{2, 2, 2}, c *= 0.5f;
  EXPECT_EQ(c, (Vec3{4, -4, 8}));
}

TEST(Vec, IndexesItsComponents) {
  Vec3 a{1, 2, 3};
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(a[k], float(k + 1));
    a[k] = float(10 * k);
  }
  EXPECT_EQ(a, (Vec3{0, 10, 20}));
}

TEST(Vec, SelectsTakeTheSecondUnlessTheFirstIsBetter) {
  const float nan = std::nanf("");
  EXPECT_EQ(min(nan, 1.0f), 1.0f);
  EXPECT_EQ(max(nan, 1.0f), 1.0f);
  EXPECT_TRUE(std::isnan(min(1.0f, nan)));
  EXPECT_TRUE(std::signbit(min(0.0f, -0.0f)));
  EXPECT_FALSE(std::signbit(min(-0.0f, 0.0f)));
  EXPECT_EQ(min(Vec3{1, 5, 3}, Vec3{2, 4, 3}), (Vec3{1, 4, 3}));
  EXPECT_EQ(max(Vec3{1, 5, 3}, Vec3{2, 4, 3}), (Vec3{2, 5, 3}));
  EXPECT_EQ(min_component({3, 1, 2}), 1);
  EXPECT_EQ(max_component({3, 1, 2}), 3);
}

TEST(Vec, TheFirstOfEqualAxesIsTheLongest) {
  EXPECT_EQ(longest_axis({1, 1, 1}), 0);
  EXPECT_EQ(longest_axis({0, 1, 1}), 1);
  EXPECT_EQ(longest_axis({0, 1, 2}), 2);
  EXPECT_EQ(longest_axis({2, 1, 2}), 0);
}

TEST(Vec, FiniteMeansAllThree) {
  EXPECT_TRUE(is_finite({1, -0.0f, 3e38f}));
  for (int k = 0; k < 3; ++k)
    for (const float bad : {INFINITY, -INFINITY, NAN}) {
      Vec3 a{1, 2, 3};
      a[k] = bad;
      EXPECT_FALSE(is_finite(a));
    }
}

TEST(Vec, OrthonormalBasisIsOneForEveryDirection) {
  Random random(1);
  std::vector<Vec3> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, normalize({1e-8f, 0, -1})};
  for (int i = 0; i < 100'000; ++i) normals.push_back(normalize(random.direction()));
  for (const Vec3 n : normals) {
    Vec3 t, b;
    orthonormal_basis(n, t, b);
    EXPECT_NEAR(length(t), 1, 2e-6);
    EXPECT_NEAR(length(b), 1, 2e-6);
    EXPECT_NEAR(dot(t, b), 0, 2e-6);
    EXPECT_NEAR(dot(t, n), 0, 2e-6);
    EXPECT_NEAR(dot(cross(t, b), n), 1, 4e-6) << "right-handed";
  }
}

TEST(Id, NamesAreOrderedAndStartAsNone) {
  EXPECT_FALSE(PrimId().is_valid());
  EXPECT_TRUE(PrimId(0).is_valid());
  EXPECT_LT(PrimId(3), PrimId(4));
  EXPECT_LT(PrimId(4), PrimId()) << "none comes last";
  static_assert(!std::is_convertible_v<PrimId, GeometryId> && !std::is_convertible_v<std::uint32_t, PrimId> &&
                !std::is_convertible_v<PrimId, std::uint32_t>);
}

TEST(Random, GivesTheSameNumbersEverywhere) {
  // The first numbers of the reference implementation's demo, pcg32 with seed 42 and stream 54.
  Random random(42, 54);
  for (const std::uint32_t expected :
       {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu})
    EXPECT_EQ(random.next(), expected);
}

TEST(Random, StaysInRangeAndFillsIt) {
  Random random(7);
  float lowest = 1, highest = 0;
  int seen[10] = {};
  Vec3 sum;
  for (int i = 0; i < 100'000; ++i) {
    const float f = random.uniform();
    lowest = min(lowest, f), highest = max(highest, f);
    ++seen[random.below(10)];
    const Vec3 d = random.direction();
    ASSERT_NEAR(length(d), 1, 1e-5);
    sum += d;
    const Vec3 p = random.in_box({-1, 2, 5}, {1, 3, 5});
    ASSERT_TRUE(p.x >= -1 && p.x <= 1 && p.y >= 2 && p.y <= 3 && p.z == 5);
  }
  EXPECT_GE(lowest, 0);
  EXPECT_LT(lowest, 0.001f);
  EXPECT_LT(highest, 1);
  EXPECT_GT(highest, 0.999f);
  for (const int count : seen) EXPECT_NEAR(count, 10'000, 500);
  EXPECT_LT(length(sum), 1500) << "directions have no favourite";
}

TEST(Random, StreamsAreUnrelated) {
  Random a(1, 0), b(1, 1), c(2, 0);
  int equal = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::uint32_t x = a.next(), y = b.next(), z = c.next();
    equal += (x == y) + (x == z);
  }
  EXPECT_LT(equal, 3);
}

}  // namespace
}  // namespace boxwood
