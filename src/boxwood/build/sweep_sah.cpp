#include "boxwood/build/sweep_sah.h"

#include <algorithm>
#include <numeric>

#include "boxwood/core/radix_sort.h"

namespace boxwood {
namespace {

/// Ranges from this size on work on the three axes at the same time.
constexpr std::uint32_t kParallelAxes = 1 << 14;

template <class Body>
void for_each_axis(std::uint32_t size, Executor& executor, const Body& body) {
  if (size >= kParallelAxes) {
    parallel_for(executor, 0, 3, 1, [&](std::size_t axis) { body(static_cast<int>(axis)); });
  } else {
    for (int axis = 0; axis < 3; ++axis) body(axis);
  }
}

}  // namespace

SweepSahSplitter::SweepSahSplitter(std::span<Item> items, const BuildOptions& options, Executor& executor)
    : items_(items),
      leaf_size_(static_cast<std::uint32_t>(options.leaf_size)),
      cost_{options.traversal_cost, static_cast<std::uint32_t>(options.block_size)},
      executor_(executor),
      goes_left_(items.size()) {
  // Sort once on each axis. Items come in the order of their numbers and the sort is stable, so equal centers
  // stay in it.
  for (int axis = 0; axis < 3; ++axis) {
    order_[axis].resize(items.size());
    right_area_[axis].resize(items.size());
    scratch_[axis].resize(items.size());
    std::iota(order_[axis].begin(), order_[axis].end(), 0);
    std::span<std::uint32_t> keys = scratch_[axis];
    parallel_for(executor, 0, items.size(), 1 << 14,
                 [&](std::size_t i) { keys[i] = sortable_bits(items_[i].half_center(axis)); });
    radix_sort(keys, order_[axis], executor);
  }
}

Step<NoShare> SweepSahSplitter::step(Range range, Plan plan, NoShare) {
  Extents around;
  for (std::uint32_t i = range.begin; i < range.end; ++i) around.extend(items_[order_[0][i]]);
  const Step<NoShare> leaf{around.box.box(), range.begin, {}, {}};
  if (plan == Plan::leaf) return leaf;

  int axis = longest_axis(around.half_centers);
  std::uint32_t middle = range.begin + range.size() / 2;
  if (plan == Plan::choose) {
    // Sweep the axes, and take the cheapest split of all.
    Split found[3], best;
    for_each_axis(range.size(), executor_, [&](int k) { found[k] = find_best_split(range, k); });
    for (const Split& split : found)
      if (split.is_better_than(best)) best = split;

    // A small range stays together unless taking it apart pays.
    const double area = around.box.half_area();
    if (range.size() <= leaf_size_ &&
        !(cost_.split(area, best.children_cost) < cost_.leaf(area, range.size())))
      return leaf;
    axis = best.axis;
    middle = best.index;
  }
  part(range, axis, middle);
  return {leaf.box, middle, {}, {}};
}

/// Prices every split of the order along `axis`; `index` is the first position on the right.
Split SweepSahSplitter::find_best_split(Range range, int axis) {
  const std::uint32_t* order = order_[axis].data();
  double* right_area = right_area_[axis].data();

  // From the right: the area of everything from each position on.
  Reach right;
  for (std::uint32_t i = range.end - 1; i > range.begin; --i) {
    right.extend(items_[order[i]].reach());
    right_area[i] = right.half_area();
  }

  // From the left: the other side, and the price of the split in between.
  Split best;
  Reach left;
  for (std::uint32_t i = range.begin + 1; i < range.end; ++i) {
    left.extend(items_[order[i - 1]].reach());
    const std::uint32_t left_count = i - range.begin, right_count = range.end - i;
    const double cost = cost_.children(left.half_area(), left_count, right_area[i], right_count);
    const Split split{cost, difference(left_count, right_count), axis, i};
    if (split.is_better_than(best)) best = split;
  }
  return best;
}

/// Parts all three orders into what stands before `middle`
/// on `axis` and what does not; each part stays sorted.
void SweepSahSplitter::part(Range range, int axis, std::uint32_t middle) {
  for (std::uint32_t i = range.begin; i < range.end; ++i) goes_left_[order_[axis][i]] = i < middle;
  for_each_axis(range.size(), executor_, [&](int k) {
    if (k == axis) return;
    std::uint32_t* order = order_[k].data();
    std::uint32_t* waiting = scratch_[k].data();
    std::uint32_t left_end = range.begin, right_end = range.begin;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const std::uint32_t item = order[i];
      // Write to both and advance one of them: no branch to guess wrong.
      order[left_end] = item;
      waiting[right_end] = item;
      left_end += goes_left_[item];
      right_end += 1 - goes_left_[item];
    }
    std::copy(waiting + range.begin, waiting + right_end, order + left_end);
  });
}

void SweepSahSplitter::write_leaf(Range range, NoShare, std::span<PrimId> out) const {
  for (std::uint32_t i = 0; i < range.size(); ++i) out[i] = items_[order_[0][range.begin + i]].prim_id;
  std::sort(out.begin(), out.end());
}

}  // namespace boxwood
