#include "boxwood/build/morton_order.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "boxwood/core/morton.h"
#include "boxwood/core/radix_sort.h"

namespace boxwood {
namespace {

/// So many items are worked on by one task at a time; groups do not reach over the borders of such blocks,
/// whoever works on them.
constexpr std::size_t kBlock = 1 << 13;

/// How much larger a primitive may be than the smallest of its group, by the sum of its sides.
constexpr float kMaxRatio = 8;

float size_of_box(const Reach& reach) {
  const Lanes sides = reach.upper + reach.minus_lower;
  return sides.v[0] + sides.v[1] + sides.v[2];
}

/// Cuts one block of the order into groups, which it writes from `out` on.
class GroupMaker {
 public:
  GroupMaker(const std::uint64_t* keys, Item* items, std::uint32_t first, std::uint32_t group_size,
             Group* out)
      : keys_(keys), items_(items), first_(first), group_size_(group_size), out_(out) {}
  std::uint32_t count() const { return count_; }

  void cut(std::uint32_t begin, std::uint32_t end) {
    if (end - begin <= group_size_) return close(begin, end);

    // Cut where the highest bit changes that is not the same in all codes.
    const auto code = [&](std::uint32_t i) { return static_cast<std::uint32_t>(keys_[i] >> 32); };
    const std::uint32_t differing = code(begin) ^ code(end - 1);
    std::uint32_t middle = begin + (end - begin) / 2;
    if (differing != 0) {
      const std::uint64_t bit = std::uint64_t(std::bit_floor(differing)) << 32;
      middle = static_cast<std::uint32_t>(
          std::partition_point(keys_ + begin, keys_ + end,
                               [&](std::uint64_t key) { return (key & bit) == 0; }) -
          keys_);
    }
    cut(begin, middle);
    cut(middle, end);
  }

 private:
  void close(std::uint32_t begin, std::uint32_t end) {
    Reach all;
    float smallest = kInfinity, largest = 0;
    for (std::uint32_t i = begin; i < end; ++i) {
      const Reach reach = items_[i].reach();
      all.extend(reach);
      const float size = size_of_box(reach);
      smallest = std::min(smallest, size);
      largest = std::max(largest, size);
    }
    if (largest <= kMaxRatio * smallest) return put(all, begin, end);

    // The large ones go behind the others, each for itself.
    const auto first_large = std::stable_partition(items_ + begin, items_ + end, [&](const Item& item) {
      return size_of_box(item.reach()) <= kMaxRatio * smallest;
    });
    const auto split = static_cast<std::uint32_t>(first_large - items_);
    all = {};
    for (std::uint32_t i = begin; i < split; ++i) all.extend(items_[i].reach());
    put(all, begin, split);
    for (std::uint32_t i = split; i < end; ++i) put(items_[i].reach(), i, i + 1);
  }
  void put(const Reach& all, std::uint32_t begin, std::uint32_t end) {
    if (begin < end) out_[count_++] = Group(all, PrimId(first_ + begin), std::bit_cast<float>(end - begin));
  }

  const std::uint64_t* keys_;
  Item* items_;
  const std::uint32_t first_, group_size_;
  Group* out_;
  std::uint32_t count_ = 0;
};

/// spread_bits_by_3 of every number that a cell has on an axis.
constexpr auto kSpread = [] {
  std::array<std::uint32_t, 1024> spread{};
  for (std::uint32_t i = 0; i < spread.size(); ++i) spread[i] = spread_bits_by_3(i);
  return spread;
}();

std::uint32_t interleave(const std::array<std::int32_t, 4>& cell) {
  return kSpread[std::size_t(cell[0])] | kSpread[std::size_t(cell[1])] << 1 |
         kSpread[std::size_t(cell[2])] << 2;
}

/// The code in the upper half, the place in `items` in the lower; sorted.
RawArray<std::uint64_t> sorted_keys(std::span<const Item> items, const Reach& centers, Executor& executor) {
  RawArray<std::uint64_t> keys(items.size());

  // Ten bits an axis. Cells are cubes: what is flat has its bits on the other axes.
  const Lanes lower = Lanes::all(0) - centers.minus_lower;
  const Lanes extent = centers.upper + centers.minus_lower;
  const float longest = std::max(extent.v[0], std::max(extent.v[1], extent.v[2]));
  const Lanes scale = Lanes::all(longest > 0x1p-110f && longest < kInfinity ? 1024 / longest : 0);
  parallel_for(executor, 0, items.size(), kBlock, [&](std::size_t i) {
    const Lanes place = (twice_center(items[i].reach()) - lower) * scale;
    const auto cell = min(max(place, Lanes::all(0)), Lanes::all(1023)).whole();
    keys[i] = std::uint64_t(interleave(cell)) << 32 | i;
  });
  radix_sort_from_bit(32, {keys.data(), keys.size()}, executor);
  return keys;
}

}  // namespace

MortonOrder in_morton_order(std::span<const Item> items, const Reach& centers, std::uint32_t group_size,
                            Keep keep, Executor& executor) {
  const RawArray<std::uint64_t> keys = sorted_keys(items, centers, executor);
  const std::size_t count = items.size(), blocks = (count + kBlock - 1) / kBlock;
  MortonOrder order;
  if (keep == Keep::items)
    order.items = RawArray<Item>(count);
  else
    order.ids = RawArray<PrimId>(count);

  // Fetch the items of each block, and cut it into groups. Blocks put theirs down as they come, so that no
  // more memory is touched than there are groups.
  const RawArray<Group> mixed(count);
  std::atomic<std::size_t> taken = 0;
  std::vector<std::size_t> place(blocks), before(blocks + 1, 0);
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    const std::size_t first = block * kBlock, size = std::min(kBlock, count - first);
    RawArray<Item> own;
    if (keep == Keep::ids) own = RawArray<Item>(size);
    Item* fetched = keep == Keep::ids ? own.data() : order.items.data() + first;
    for (std::size_t i = 0; i < size; ++i) fetched[i] = items[std::uint32_t(keys[first + i])];
    const RawArray<Group> groups(size);
    GroupMaker maker(keys.data() + first, fetched, std::uint32_t(first), group_size, groups.data());
    maker.cut(0, std::uint32_t(size));
    before[block + 1] = maker.count();
    place[block] = taken.fetch_add(maker.count());
    std::copy_n(groups.data(), maker.count(), mixed.data() + place[block]);
    if (keep == Keep::ids)
      for (std::size_t i = 0; i < size; ++i) order.ids[first + i] = fetched[i].prim_id;
  });

  // Bring the blocks' groups into order.
  for (std::size_t block = 0; block < blocks; ++block) before[block + 1] += before[block];
  order.groups = RawArray<Group>(before[blocks]);
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    std::copy_n(mixed.data() + place[block], before[block + 1] - before[block],
                order.groups.data() + before[block]);
  });
  return order;
}

}  // namespace boxwood
