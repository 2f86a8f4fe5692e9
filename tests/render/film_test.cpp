// The film: exact sums in any order and grouping, signs, and the way to words and back.
#include "boxwood/render/film.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/render/picture.h"

namespace boxwood::render {
namespace {

/// Numbers of every size that a float has, many of which cancel.
std::vector<float> wild_floats(int count, std::uint64_t seed, int smallest_exponent, int largest_exponent) {
  Random random(seed);
  std::vector<float> values;
  for (int i = 0; i < count; ++i) {
    const int exponent =
        smallest_exponent +
        static_cast<int>(random.below(static_cast<std::uint32_t>(largest_exponent - smallest_exponent)));
    values.push_back(std::ldexp(random.uniform(-1, 1), exponent));
  }
  return values;
}

struct Sum {
  std::array<Digits, 1> digits{};
  std::uint8_t place = 0;
  void add(float x, int sign = 1) { add_exactly(digits, place, {&x, 1}, sign); }
  void add(const Sum& other) { add_exactly(digits, place, other.digits, other.place); }
  double value() const { return value_of(digits[0], place); }
  friend bool operator==(const Sum&, const Sum&) = default;
};

TEST(ExactSum, IsTheSameInAnyOrderAndAnyGrouping) {
  for (const auto& [low, high] :
       {std::pair(-149, 128), std::pair(-30, 30), std::pair(-149, -120), std::pair(100, 128)}) {
    std::vector<float> values = wild_floats(3000, 7, low, high);
    Sum expected;
    for (const float x : values) expected.add(x);
    std::mt19937 shuffler(1);
    for (int round = 0; round < 20; ++round) {
      std::shuffle(values.begin(), values.end(), shuffler);
      // Groups of a few, each summed alone, then together.
      Sum all;
      for (std::size_t begin = 0; begin < values.size();) {
        Sum group;
        const std::size_t end = std::min<std::size_t>(values.size(), begin + 1 + shuffler() % 40);
        for (; begin < end; ++begin) group.add(values[begin]);
        all.add(group);
      }
      ASSERT_EQ(all, expected) << low << " to " << high << ", round " << round;
    }
  }
}

TEST(ExactSum, IsAsCloseAsItSays) {
  for (const auto& [low, high] :
       {std::pair(-149, 128), std::pair(-4, 4), std::pair(-20, 20), std::pair(-149, -126)}) {
    const std::vector<float> values = wild_floats(1000, 11, low, high);
    Sum sum;
    long double exact = 0;
    float largest = 0;
    for (const float x : values) {
      sum.add(x);
      exact += x;
      largest = std::max(largest, std::fabs(x));
    }
    EXPECT_NEAR(sum.value(), static_cast<double>(exact),
                1000 * std::ldexp(static_cast<double>(largest), -40));
  }
}

TEST(ExactSum, IsExactWhereNothingFallsOff) {
  Sum sum;
  for (int i = 0; i < 1 << 20; ++i) sum.add(16777215.0f);
  EXPECT_EQ(sum.value(), 16777215.0 * (1 << 20));
  for (int i = 0; i < 1 << 19; ++i) sum.add(16777215.0f, -1);
  EXPECT_EQ(sum.value(), 16777215.0 * (1 << 19));
  Sum tiny;
  for (int i = 0; i < 1000; ++i) tiny.add(std::numeric_limits<float>::denorm_min());
  EXPECT_EQ(tiny.value(), 1000.0 * std::numeric_limits<float>::denorm_min());
  Sum huge;
  for (int i = 0; i < 1000; ++i) huge.add(std::numeric_limits<float>::max());
  EXPECT_EQ(huge.value(), 1000.0 * std::numeric_limits<float>::max());
}

TEST(TileSums, GoToWordsAndBack) {
  const std::vector<int> groups{3, 1, 2};
  TileSums sums(5, groups);
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const std::size_t pixel = random.below(5), group = random.below(3);
    const std::array values{random.uniform(), random.uniform(0, 1e20f), random.uniform()};
    sums.add(pixel, group, std::span(values).first(static_cast<std::size_t>(groups[group])),
             i % 7 == 0 ? -1 : 1);
    sums.count_sample(pixel);
  }
  std::vector<std::uint32_t> words(sums.word_count(), 0xdeadbeef);
  sums.to_words(words);
  TileSums back(5, groups);
  back.from_words(words);
  EXPECT_EQ(back, sums);
}

TEST(TileSums, TakeAnyWords) {
  TileSums sums(3, std::vector<int>{3, 1});
  const std::vector<std::uint32_t> words(sums.word_count(), 0xffffffff);
  sums.from_words(words);
  std::array<double, 3> found{};
  sums.read(2, 0, found);
  EXPECT_TRUE(std::isfinite(found[0]));
}

TEST(Film, DividesByWhatWasCounted) {
  Film film(3, 1, {3, 1});
  TileSums tile = film.empty_tile(0);
  tile.add(0, 0, std::array{1.0f, 2.0f, 3.0f}, 1);
  tile.add(0, 0, std::array{3.0f, 2.0f, 1.0f}, 1);
  tile.add(1, 0, std::array{5.0f, 5.0f, 5.0f}, 1);
  tile.add(1, 0, std::array{5.0f, 5.0f, 5.0f}, 1);
  tile.add(1, 0, std::array{1.0f, 1.0f, 1.0f}, -1);
  EXPECT_TRUE(film.add(0, 0, tile));
  const Image image = picture_of(film, Mode::path, {});
  EXPECT_EQ(image.pixels, (std::vector<float>{2, 2, 2, 9, 9, 9, 0, 0, 0}));
}

TEST(Film, TakesEachUnitOnce) {
  Film film(20, 20, {3, 1});
  TileSums tile = film.empty_tile(3);
  tile.add(0, 0, std::array{1.0f, 1.0f, 1.0f}, 1);
  EXPECT_TRUE(film.add(3, 5, tile, {10, 1, 0}));
  EXPECT_FALSE(film.add(3, 5, tile, {10, 1, 0})) << "the same unit again";
  EXPECT_TRUE(film.add(3, 6, tile, {10, 1, 0}));
  EXPECT_TRUE(film.has(3, 5));
  EXPECT_FALSE(film.has(3, 4));
  film.begin_round();
  EXPECT_FALSE(film.has(3, 5));
  film.with_tile(3, [](const Film::Tile& held) {
    EXPECT_EQ(held.sums.count(0, 0), 2);
    EXPECT_EQ(held.effort, (Effort{20, 2, 0}));
  });
}

}  // namespace
}  // namespace boxwood::render
