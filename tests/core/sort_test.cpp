// Morton codes and the radix sort: checked bit by bit, and against std::stable_sort.
#include <algorithm>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "boxwood/core/morton.h"
#include "boxwood/core/radix_sort.h"
#include "boxwood/core/random.h"

namespace boxwood {
namespace {

/// One bit at a time: slow and plain.
std::uint64_t interleave(const std::uint64_t (&cell)[3], int bits) {
  std::uint64_t code = 0;
  for (int bit = 0; bit < bits; ++bit)
    for (int k = 0; k < 3; ++k) code |= (cell[k] >> bit & 1) << (3 * bit + k);
  return code;
}

TEST(Morton, InterleavesEveryBit) {
  Random random(1);
  for (int i = 0; i < 10'000; ++i) {
    const std::uint64_t cell[3] = {random.next(), random.next(), random.next()};
    EXPECT_EQ(interleave({cell[0], 0, 0}, 10), spread_bits_by_3(std::uint32_t(cell[0])));
    EXPECT_EQ(interleave({cell[0], 0, 0}, 21), spread_bits_by_3(cell[0]));
    const Box3 box{{0, 0, 0}, splat(1024)};
    const Vec3 p{float(cell[0] % 1024), float(cell[1] % 1024), float(cell[2] % 1024)};
    EXPECT_EQ(morton30(p, box), interleave({cell[0] % 1024, cell[1] % 1024, cell[2] % 1024}, 10));
    const Box3 fine{{0, 0, 0}, splat(0x1p21f)};
    const Vec3 q{float(cell[0] % 0x200000), float(cell[1] % 0x200000), float(cell[2] % 0x200000)};
    EXPECT_EQ(morton63(q, fine),
              interleave({cell[0] % 0x200000, cell[1] % 0x200000, cell[2] % 0x200000}, 21));
  }
}

TEST(Morton, CornersGetTheFirstAndTheLastCode) {
  for (const float scale : {1e-45f, 1e-30f, 1.0f, 1e30f, 3e38f}) {
    const Box3 box{splat(-scale), splat(scale)};
    EXPECT_EQ(morton30(box.lower, box), 0u);
    EXPECT_EQ(morton63(box.lower, box), 0u);
    EXPECT_EQ(morton30(box.upper, box), (1u << 30) - 1);
    EXPECT_EQ(morton63(box.upper, box), (1ull << 63) - 1);
    EXPECT_EQ(morton30(splat(0), box), 7u << 27) << "the middle opens the upper half of each axis";
  }
}

TEST(Morton, FlatAndEmptyBoxesGiveCodeZeroOnTheirAxes) {
  const Box3 flat{{0, 5, 0}, {1, 5, 1}};
  EXPECT_EQ(morton30({1, 5, 1}, flat), morton30({1, 0, 1}, {{0, 0, 0}, {1, 1, 1}}));
  EXPECT_EQ(morton30({1, 2, 3}, Box3{}), 0u);
  EXPECT_EQ(morton63({1, 2, 3}, Box3{}), 0u);
  EXPECT_EQ(morton63({1, 2, 3}, {{1, 2, 3}, {1, 2, 3}}), 0u);
}

TEST(Morton, OutsideGoesToTheBorderAndNanToTheFirstCell) {
  const Box3 box{{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(morton30(splat(-7), box), 0u);
  EXPECT_EQ(morton30(splat(7), box), (1u << 30) - 1);
  EXPECT_EQ(morton30(splat(kInfinity), box), (1u << 30) - 1);
  EXPECT_EQ(morton30(splat(std::nanf("")), box), 0u);
}

TEST(Morton, IsMonotonicOnEachAxisAndTheLongCodeRefinesTheShort) {
  Random random(2);
  for (int i = 0; i < 100'000; ++i) {
    const float scale = std::ldexp(1.0f, int(random.below(200)) - 100);
    const Box3 box{splat(-scale), splat(scale * random.uniform())};
    const Vec3 p = random.in_box(box.lower, box.upper);
    Vec3 q = p;
    const int axis = static_cast<int>(random.below(3));
    q[axis] = random.uniform(p[axis], box.upper[axis]);
    if (q[axis] < p[axis]) continue;
    EXPECT_LE(morton30(p, box), morton30(q, box));
    EXPECT_LE(morton63(p, box), morton63(q, box));
    EXPECT_EQ(morton63(p, box) >> 33, morton30(p, box));
  }
}

template <class Key>
class RadixSort : public ::testing::Test {};
using Keys = ::testing::Types<std::uint32_t, std::uint64_t>;
TYPED_TEST_SUITE(RadixSort, Keys);

TYPED_TEST(RadixSort, EqualsAStableSortForAnyNumberOfThreads) {
  using Key = TypeParam;
  const auto two = make_executor(2), eight = make_executor(8);
  Random random(3);
  // Sizes on both sides of a block, and keys from all equal to all bits in use.
  for (const std::size_t n : {0, 1, 2, 3, 255, 65'535, 65'536, 65'537, 300'000})
    for (const int bits : {0, 1, 8, 9, 31, int(8 * sizeof(Key))}) {
      std::vector<Key> keys(n);
      std::vector<std::uint32_t> values(n), order(n);
      for (std::size_t i = 0; i < n; ++i) {
        const std::uint64_t raw = std::uint64_t(random.next()) << 32 | random.next();
        keys[i] = bits == 0 ? Key(42) : static_cast<Key>(raw >> (64 - bits));
        values[i] = random.next();
      }
      std::iota(order.begin(), order.end(), 0);
      std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return keys[a] < keys[b]; });

      for (Executor* executor : {&serial_executor(), two.get(), eight.get(), &default_executor()}) {
        std::vector<Key> sorted = keys;
        std::vector<std::uint32_t> moved = values;
        radix_sort(sorted, moved, *executor);
        bool is_right = true;
        for (std::size_t i = 0; i < n; ++i)
          is_right &= sorted[i] == keys[order[i]] && moved[i] == values[order[i]];
        EXPECT_TRUE(is_right) << n << " keys of " << bits << " bits";
      }
    }
}

TYPED_TEST(RadixSort, RefusesSpansOfDifferentLength) {
  std::vector<TypeParam> keys(3);
  std::vector<std::uint32_t> values(4);
  EXPECT_THROW(radix_sort(keys, values, serial_executor()), std::invalid_argument);
}

TEST(SortableBits, OrderLikeTheFloats) {
  const std::vector<float> ascending{-kInfinity, -3e38f, -1, -1e-30f, -1e-45f,  0,
                                     1e-45f,     1e-30f, 1,  3e38f,   kInfinity};
  for (std::size_t i = 1; i < ascending.size(); ++i)
    EXPECT_LT(sortable_bits(ascending[i - 1]), sortable_bits(ascending[i])) << ascending[i];
  EXPECT_EQ(sortable_bits(-0.0f), sortable_bits(0.0f));
}

TEST(RadixSort, FromABitOnKeepsWhatStandsBelow) {
  Random random(11);
  for (const std::size_t count : {0, 1, 1000, 200'000}) {
    std::vector<std::uint64_t> keys(count);
    for (std::size_t i = 0; i < count; ++i) keys[i] = std::uint64_t(random.below(1000)) << 40 | (count - i);
    std::vector<std::uint64_t> expected = keys;
    std::stable_sort(expected.begin(), expected.end(),
                     [](std::uint64_t a, std::uint64_t b) { return a >> 32 < b >> 32; });
    for (Executor* executor : {&serial_executor(), &default_executor()}) {
      std::vector<std::uint64_t> found = keys;
      radix_sort_from_bit(32, found, *executor);
      EXPECT_EQ(found, expected);
    }
  }
}

}  // namespace
}  // namespace boxwood
