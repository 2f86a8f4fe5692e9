#include "boxwood/build/binned_sah.h"

#include <algorithm>

#include "boxwood/build/morton_order.h"

namespace boxwood {
namespace {

/// Ranges from this size on are worked on by blocks of kBlock items at the same time; neither shows in the
/// tree.
constexpr std::size_t kParallelSize = 1 << 16, kBlock = 1 << 14;

/// Up to so many primitives are split in the best of all ways; of so few the centers' range is looked up
/// again, because a range that is only guessed leaves too many of a few bins empty.
constexpr std::uint32_t kFew = 4, kLookAgain = 64;

/// Larger ranges are worked on as groups of at most kGroupSize primitives.
constexpr std::uint32_t kTakeApart = 128, kGroupSize = 8;

/// Adds all items to `all` with `add(T&, items)`; `all` is empty before. `merge(T&, const T&)` adds two.
template <class T, class Add, class Merge>
void reduce(T& all, std::span<const Item> items, Executor& executor, const Add& add, const Merge& merge) {
  if (items.size() < kParallelSize) return add(all, items);

  std::vector<T> found((items.size() + kBlock - 1) / kBlock, all);
  parallel_for(executor, 0, found.size(), 1, [&](std::size_t block) {
    add(found[block], items.subspan(block * kBlock, std::min(kBlock, items.size() - block * kBlock)));
  });
  for (const T& part : found) merge(all, part);
}

/// Parts many: all go to `room`, first those that go left, then the others; both keep their order. Returns
/// how many go left.
template <class GoesLeft>
std::size_t part_many(std::span<const Item> items, Item* room, Executor& executor,
                      const GoesLeft& goes_left) {
  // Count, so that each block knows where its items go.
  const std::size_t blocks = (items.size() + kBlock - 1) / kBlock;
  const auto block_end = [&](std::size_t block) { return std::min(items.size(), (block + 1) * kBlock); };
  std::vector<std::size_t> left_before(blocks + 1, 0);
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    std::size_t count = 0;
    for (std::size_t i = block * kBlock; i < block_end(block); ++i) count += goes_left(items[i]);
    left_before[block + 1] = count;
  });
  for (std::size_t block = 0; block < blocks; ++block) left_before[block + 1] += left_before[block];

  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    std::size_t next[2] = {left_before[blocks] + block * kBlock - left_before[block], left_before[block]};
    for (std::size_t i = block * kBlock; i < block_end(block); ++i)
      room[next[goes_left(items[i])]++] = items[i];
  });
  return left_before[blocks];
}

int bins_for(std::uint32_t count, int most) {
  return std::min(most, count < 16 ? 4 : count < 64 ? 8 : most);
}

}  // namespace

BinnedSahSplitter::BinnedSahSplitter(const Items& items, const BuildOptions& options, Executor& executor)
    : items_(items.full.data(), items.full.size()),
      room_(items.full.size()),
      leaf_size_(static_cast<std::uint32_t>(options.leaf_size)),
      max_bins_(options.bins),
      cost_{options.traversal_cost, static_cast<std::uint32_t>(options.block_size)},
      executor_(executor) {
  const Bounds& bounds = items.bounds;
  if (items_.size() <= kTakeApart) {
    root_ = {items_, room_.data(), false, bounds.box, bounds.centers};
  } else {
    order_ = in_morton_order(items_, bounds.centers, kGroupSize, Keep::items, executor_);
    group_room_ = RawArray<Group>(order_.groups.size());
    root_ = {
        {order_.groups.data(), order_.groups.size()}, group_room_.data(), true, bounds.box, bounds.centers};
  }
}

Step<BinnedSahSplitter::Share> BinnedSahSplitter::step(Range range, Plan plan, const Share& share) {
  if (share.are_groups && (plan != Plan::choose || range.size() <= kTakeApart))
    return step(range, plan, take_apart(range, share));
  if (plan == Plan::leaf) return {share.box.box(), range.begin, share, share};
  if (plan == Plan::halve) return halve(range, share);
  if (range.size() <= leaf_size_ && range.size() <= cost_.block)
    return {share.box.box(), range.begin, share, share};
  return range.size() <= kFew ? split_few(range, share) : split_at_plane(range, share);
}

BinnedSahSplitter::Share BinnedSahSplitter::take_apart(Range range, const Share& share) const {
  // A few are worked on where the cache keeps them: a thread is done with them before it takes the next
  // apart.
  struct Bench {
    Item items[kTakeApart], room[kTakeApart];
  };
  thread_local Bench bench;
  const bool are_few = range.size() <= kTakeApart;
  Share single{are_few ? std::span(bench.items, range.size()) : items_.subspan(range.begin, range.size()),
               are_few ? bench.room : room_.data() + range.begin, false, share.box, share.centers};
  Item* out = single.items.data();
  for (const Group& group : share.items) {
    const Item* first = order_.items.data() + first_of(group);
    out = std::copy(first, first + size_of(group), out);
  }
  return single;
}

Step<BinnedSahSplitter::Share> BinnedSahSplitter::split_at_plane(Range range, const Share& share) {
  const std::uint32_t count = range.size();
  const std::span<Item> items = share.items;

  // Fill the bins.
  Reach centers = share.centers;
  if (count <= kLookAgain) {
    Bounds bounds;
    kernels_.bound(bounds, items);
    centers = bounds.centers;
  }
  const Binning binning(centers, bins_for(count, max_bins_));
  Histogram histogram(binning.bins);
  reduce(
      histogram, items, executor_,
      [&](Histogram& all, std::span<const Item> some) {
        kernels_.fill(all, binning, some, share.are_groups);
      },
      kernels_.merge);
  const Cut cut = kernels_.best_cut(histogram, share.box, count, cost_);

  // Nothing to gain: any two halves.
  const float area = Scale(share.box).area(share.box);
  const bool is_found = cut.axis >= 0 && cut.children_cost < cost_.leaf(area, count);
  if (!is_found && count > leaf_size_)
    return halve(range, share.are_groups ? take_apart(range, share) : share);
  if (!is_found || !should_split(count, area, cut.children_cost))
    return {share.box.box(), range.begin, share, share};

  // Part the primitives. What is known of the centers on each side: they are on that side of the plane, and
  // in that side's box.
  Step<Share> step{share.box.box(), range.begin + cut.left_count, share, share};
  if (items.size() < kParallelSize) {
    const std::size_t left = kernels_.part(items, share.room, binning, cut.axis, cut.bin);
    const std::size_t right = items.size() - left;
    step.left.items = items.first(left);
    step.left.room = share.room + right;
    step.right.items = {share.room, right};
    step.right.room = items.data() + left;
  } else {
    const std::size_t left = part_many(items, share.room, executor_, [&](const Item& item) {
      return is_before(item, binning, cut.axis, cut.bin);
    });
    step.left.items = {share.room, left};
    step.left.room = items.data();
    step.right.items = {share.room + left, items.size() - left};
    step.right.room = items.data() + left;
  }
  const auto narrow = [&](Share& half, const Reach& box) {
    half.box = box;
    half.centers.minus_lower = min(centers.minus_lower, box.minus_lower + box.minus_lower);
    half.centers.upper = min(centers.upper, box.upper + box.upper);
  };
  narrow(step.left, cut.left);
  narrow(step.right, cut.right);
  const float border = binning.border(cut.axis, cut.bin);
  step.left.centers.upper.v[cut.axis] = std::min(step.left.centers.upper.v[cut.axis], border);
  step.right.centers.minus_lower.v[cut.axis] = std::min(step.right.centers.minus_lower.v[cut.axis], -border);
  return step;
}

/// Prices every way to deal two to four primitives to two sides.
Step<BinnedSahSplitter::Share> BinnedSahSplitter::split_few(Range range, const Share& share) const {
  const std::uint32_t count = range.size(), all = (1u << count) - 1;
  const Scale scale(share.box);
  constexpr std::uint8_t kMembers[1 << (kFew - 1)] = {0, 1, 1, 2, 1, 2, 2, 3};

  // The union of each set of primitives, from one with a member less.
  Reach box[1 << kFew];
  float area[1 << kFew];
  for (std::uint32_t set = 1; set < all; ++set) {
    box[set] = box[set & (set - 1)];
    box[set].extend(share.items[std::countr_zero(set)].reach());
    area[set] = scale.area(box[set]);
  }

  // Sets without the last primitive are one side of each way to split. Pairs first: equal prices go to the
  // more even split.
  std::uint32_t best = 0;
  float least = kInfinity;
  for (const std::uint32_t set : {3u, 5u, 6u, 1u, 2u, 4u, 7u}) {
    if (set >= (all + 1) / 2) continue;
    const auto price =
        static_cast<float>(cost_.children(area[set], kMembers[set], area[all ^ set], count - kMembers[set]));
    if (price < least) {
      least = price;
      best = set;
    }
  }
  if (best == 0) return halve(range, share);
  if (!should_split(count, scale.area(share.box), least)) return {share.box.box(), range.begin, share, share};

  const std::uint32_t left_count = kMembers[best];
  Item sides[kFew];
  std::uint32_t next[2] = {left_count, 0};
  for (std::uint32_t i = 0; i < count; ++i) sides[next[best >> i & 1]++] = share.items[i];
  std::copy(sides, sides + count, share.items.begin());
  Step<Share> step{share.box.box(), range.begin + left_count, share, share};
  step.left.box = box[best];
  step.left.items = share.items.first(left_count);
  step.right.items = share.items.subspan(left_count);
  step.right.box = box[all ^ best];
  return step;
}

/// Where levels are short, and where all centers fall together.
Step<BinnedSahSplitter::Share> BinnedSahSplitter::halve(Range range, const Share& share) const {
  const std::uint32_t half = range.size() / 2;
  const std::span<Item> items = share.items;
  Bounds bounds;
  kernels_.bound(bounds, items);
  const int axis = longest_axis(bounds.centers);
  if (bounds.centers.upper.v[axis] > bounds.centers.lower(axis))
    std::nth_element(items.begin(), items.begin() + half, items.end(), ByCenter{axis});

  Step<Share> step{share.box.box(), range.begin + half, share, share};
  step.left.items = items.first(half);
  step.right.items = items.subspan(half);
  step.right.room += half;
  const auto look = [&](Share& side, std::span<const Item> some) {
    Bounds around;
    kernels_.bound(around, some);
    side.box = around.box;
    side.centers = around.centers;
  };
  look(step.left, items.first(half));
  look(step.right, items.subspan(half));
  return step;
}

void BinnedSahSplitter::write_leaf(Range, const Share& share, std::span<PrimId> out) const {
  std::size_t next = 0;
  for (const Item& item : share.items) {
    if (!share.are_groups) {
      out[next++] = item.prim_id;
      continue;
    }
    for (std::uint32_t i = 0; i < size_of(item); ++i) out[next++] = order_.items[first_of(item) + i].prim_id;
  }
}

}  // namespace boxwood
