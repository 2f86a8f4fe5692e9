#include "boxwood/build/morton_order.h"

#include <algorithm>

#include "boxwood/core/morton.h"
#include "boxwood/core/radix_sort.h"

namespace boxwood {
namespace {

constexpr std::size_t kBlock = 1 << 14;

/// How much longer a primitive may be than the shortest of its group.
constexpr float kMaxRatio = 8;

float longest_side(const Item& item) {
  float longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, item.upper[k] + item.minus_lower[k]);
  return longest;
}

/// Cuts one block of the order into groups, which it writes from `out` on.
class GroupMaker {
 public:
  GroupMaker(MortonOrder& order, Group* out)
      : items_(order.items.data()), codes_(order.codes.data(), order.codes.size()), out_(out) {}
  std::uint32_t count() const { return count_; }

  void cut(std::uint32_t begin, std::uint32_t end) {
    if (end - begin <= kGroupSize) return close(begin, end);

    // Cut where the highest bit changes that is not the same in all.
    const std::uint32_t first = codes_[begin], last = codes_[end - 1];
    std::uint32_t middle = begin + (end - begin) / 2;
    if (first != last) {
      const std::uint32_t bit = std::bit_floor(first ^ last);
      middle = static_cast<std::uint32_t>(
          std::partition_point(codes_.begin() + begin, codes_.begin() + end,
                               [&](std::uint32_t code) { return (code & bit) == 0; }) -
          codes_.begin());
    }
    cut(begin, middle);
    cut(middle, end);
  }

 private:
  void close(std::uint32_t begin, std::uint32_t end) {
    float shortest = kInfinity;
    for (std::uint32_t i = begin; i < end; ++i) shortest = std::min(shortest, longest_side(items_[i]));
    const auto large = std::stable_partition(items_ + begin, items_ + end, [&](const Item& item) {
      return longest_side(item) <= kMaxRatio * shortest;
    });
    const auto first_large = static_cast<std::uint32_t>(large - items_);
    put(begin, first_large);
    for (std::uint32_t i = first_large; i < end; ++i) put(i, i + 1);
  }
  void put(std::uint32_t begin, std::uint32_t end) {
    Reach all;
    for (std::uint32_t i = begin; i < end; ++i) all.extend(items_[i].reach());
    out_[count_++] = Group(all, PrimId(begin), std::bit_cast<float>(end - begin));
  }

  Item* items_;
  std::span<const std::uint32_t> codes_;
  Group* out_;
  std::uint32_t count_ = 0;
};

}  // namespace

MortonOrder in_morton_order(std::span<const Item> items, const Reach& centers, Executor& executor) {
  const std::size_t count = items.size();
  MortonOrder order{RawArray<Item>(count), RawArray<std::uint32_t>(count)};
  const RawArray<std::uint32_t> places(count);

  // Ten bits an axis. Cells are cubes: what is flat has its bits on the other axes.
  Lanes lower = Lanes::all(0) - centers.minus_lower;
  const Lanes extent = centers.upper + centers.minus_lower;
  const float longest = std::max(extent.v[0], std::max(extent.v[1], extent.v[2]));
  const float scale = longest > 0x1p-110f && longest < kInfinity ? 1024 / longest : 0;
  executor.for_range(0, count, kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Lanes place = (twice_center(items[i].reach()) - lower) * Lanes::all(scale);
      const auto cell = min(max(place, Lanes::all(0)), Lanes::all(1023)).whole();
      order.codes[i] = spread_bits_by_3(std::uint32_t(cell[0])) |
                       spread_bits_by_3(std::uint32_t(cell[1])) << 1 |
                       spread_bits_by_3(std::uint32_t(cell[2])) << 2;
      places[i] = static_cast<std::uint32_t>(i);
    }
  });
  radix_sort({order.codes.data(), count}, {places.data(), count}, executor);
  parallel_for(executor, 0, count, kBlock, [&](std::size_t i) { order.items[i] = items[places[i]]; });
  return order;
}

RawArray<Group> make_groups(MortonOrder& order, Executor& executor) {
  const std::size_t count = order.items.size(), blocks = (count + kBlock - 1) / kBlock;
  RawArray<Group> sparse(count);
  std::vector<std::size_t> before(blocks + 1, 0);
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    GroupMaker maker(order, sparse.data() + block * kBlock);
    maker.cut(static_cast<std::uint32_t>(block * kBlock),
              static_cast<std::uint32_t>(std::min(count, (block + 1) * kBlock)));
    before[block + 1] = maker.count();
  });

  // Move the blocks' groups together.
  for (std::size_t block = 0; block < blocks; ++block) before[block + 1] += before[block];
  RawArray<Group> groups(before[blocks]);
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    const Group* from = sparse.data() + block * kBlock;
    std::copy(from, from + (before[block + 1] - before[block]), groups.data() + before[block]);
  });
  return groups;
}

}  // namespace boxwood
