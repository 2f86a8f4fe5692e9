#include "boxwood/build/binned_sah.h"

#include <algorithm>
#include <cmath>

namespace boxwood {
namespace {

/// Which bin a half center falls into, on each axis:
/// monotonic in the center, so that bins are slabs in order.
class Binning {
 public:
  Binning(const Reach& half_centers, int bins) : bins_(bins) {
    float scale[3];
    for (int k = 0; k < 3; ++k) {
      // Where the scale overflows, or there is nothing to tell apart, everything falls into bin 0.
      const float extent = half_centers.upper.v[k] - half_centers.lower(k);
      scale[k] = float(bins) / extent;
      is_useful_[k] = extent > 0 && scale[k] < 0x1p120f;
      if (!is_useful_[k]) scale[k] = 0;
    }
    lower_ = {Lanes::Register{half_centers.lower(0), half_centers.lower(1), half_centers.lower(2), 0}};
    scale_ = {Lanes::Register{scale[0], scale[1], scale[2], 0}};
  }
  bool is_useful(int axis) const { return is_useful_[axis]; }
  int bins() const { return bins_; }

  int bin(const Item& item, int axis) const {
    return std::min(bins_ - 1, int((item.half_center(axis) - lower_.v[axis]) * scale_.v[axis]));
  }
  /// The same for all axes at once.
  Lanes places(const Reach& reach) const { return (half_center(reach) - lower_) * scale_; }
  int bin(Lanes places, int axis) const { return std::min(bins_ - 1, int(places.v[axis])); }

 private:
  int bins_;
  bool is_useful_[3];
  Lanes lower_, scale_;
};

/// What fell into the bins.
struct Histogram {
  Reach reach[3][BinnedSahSplitter::kMaxBins];
  std::uint32_t count[3][BinnedSahSplitter::kMaxBins];

  int bins;

  explicit Histogram(int bins) : bins(bins) {
    for (int k = 0; k < 3; ++k) {
      std::fill_n(reach[k], bins, Reach{});
      std::fill_n(count[k], bins, 0);
    }
  }
  void extend(const Histogram& other) {
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < bins; ++i) {
        reach[k][i].extend(other.reach[k][i]);
        count[k][i] += other.count[k][i];
      }
  }
  void add(const Binning& binning, std::span<const Item> items) {
    for (const Item& item : items) {
      const Reach box = item.reach();
      const Lanes places = binning.places(box);
      for (int k = 0; k < 3; ++k) {
        const int bin = binning.bin(places, k);
        reach[k][bin].extend(box);
        ++count[k][bin];
      }
    }
  }
};

/// Prices every plane between two bins that leaves something on both sides;
/// `index` is the first bin on the right.
Split find_best_split(const Histogram& histogram, const Binning& binning, std::uint32_t total) {
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!binning.is_useful(axis)) continue;
    const Reach* reach = histogram.reach[axis];
    const std::uint32_t* count = histogram.count[axis];

    // From the right: the area of everything from each bin on.
    double right_area[BinnedSahSplitter::kMaxBins];
    Reach right;
    for (int i = binning.bins() - 1; i > 0; --i) {
      right.extend(reach[i]);
      right_area[i] = right.half_area();
    }

    // From the left: the other side, and the price of the plane in between.
    Reach left;
    std::uint32_t left_count = 0;
    for (int i = 1; i < binning.bins(); ++i) {
      left.extend(reach[i - 1]);
      left_count += count[i - 1];
      const std::uint32_t right_count = total - left_count;
      if (count[i - 1] == 0 || right_count == 0) continue;
      const double cost = SahCost::children(left.half_area(), left_count, right_area[i], right_count);
      const Split split{cost, difference(left_count, right_count), axis, static_cast<std::uint32_t>(i)};
      if (split.is_better_than(best)) best = split;
    }
  }
  return best;
}

/// Ranges from this size on are worked on by blocks of
/// kBlock items at the same time; neither shows in the tree.
constexpr std::size_t kParallelSize = 1 << 16, kBlock = 1 << 14;

/// Adds all items to `all` with `add(T&, items)`; `all` is empty before.
template <class T, class Add>
void reduce(T& all, std::span<const Item> items, Executor& executor, const Add& add) {
  if (items.size() < kParallelSize) return add(all, items);

  std::vector<T> found((items.size() + kBlock - 1) / kBlock, all);
  parallel_for(executor, 0, found.size(), 1, [&](std::size_t block) {
    add(found[block], items.subspan(block * kBlock, std::min(kBlock, items.size() - block * kBlock)));
  });
  for (const T& part : found) all.extend(part);
}

/// Brings the items that go left to the front,
/// by way of `scratch` where the range is large; returns how many they are.
template <class GoesLeft>
std::uint32_t part(std::span<Item> items, std::span<Item> scratch, Executor& executor,
                   const GoesLeft& goes_left) {
  if (items.size() < kParallelSize)
    return static_cast<std::uint32_t>(std::partition(items.begin(), items.end(), goes_left) - items.begin());

  // Count, so that each block knows where its items go,
  // left ones from the front and right ones from there on.
  const std::size_t blocks = (items.size() + kBlock - 1) / kBlock;
  const auto block_end = [&](std::size_t block) { return std::min(items.size(), (block + 1) * kBlock); };
  std::vector<std::size_t> left_before(blocks + 1, 0);
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < block_end(block); ++i)
      left_before[block + 1] += goes_left(items[i]);
  });
  for (std::size_t block = 0; block < blocks; ++block) left_before[block + 1] += left_before[block];

  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    std::size_t left = left_before[block], right = left_before[blocks] + block * kBlock - left;
    for (std::size_t i = block * kBlock; i < block_end(block); ++i)
      scratch[goes_left(items[i]) ? left++ : right++] = items[i];
  });
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    std::copy(scratch.begin() + block * kBlock, scratch.begin() + block_end(block),
              items.begin() + block * kBlock);
  });
  return static_cast<std::uint32_t>(left_before[blocks]);
}

}  // namespace

BinnedSahSplitter::BinnedSahSplitter(std::vector<Item>& items, const BuildOptions& options,
                                     Executor& executor)
    : items_(items),
      scratch_(items.size() < kParallelSize ? 0 : items.size()),
      leaf_size_(static_cast<std::uint32_t>(options.leaf_size)),
      max_bins_(options.bins),
      cost_{options.traversal_cost},
      executor_(executor) {}

Step BinnedSahSplitter::step(Range range, Plan plan) {
  const std::span<Item> items = items_.subspan(range.begin, range.size());
  Extents around;
  reduce(around, items, executor_, [](Extents& all, std::span<const Item> some) {
    for (const Item& item : some) all.extend(item);
  });
  const Step leaf{around.box.box(), range.begin};
  if (plan == Plan::leaf) return leaf;

  // A small range stays together unless taking it apart pays.
  const double area = around.box.half_area();
  const auto must_or_should_split = [&](double children_cost) {
    return range.size() > leaf_size_ || cost_.split(area, children_cost) < SahCost::leaf(area, range.size());
  };

  if (plan == Plan::choose && range.size() > 2) {
    // Fill the bins. More of them than primitives cost time and tell nothing.
    const int bins = static_cast<int>(std::min<std::uint32_t>(max_bins_, std::max(4u, range.size())));
    const Binning binning(around.half_centers, bins);
    Histogram histogram(bins);
    reduce(histogram, items, executor_,
           [&](Histogram& all, std::span<const Item> some) { all.add(binning, some); });
    const Split best = find_best_split(histogram, binning, range.size());
    if (best.exists()) {
      if (!must_or_should_split(best.children_cost)) return leaf;
      const std::span<Item> scratch =
          scratch_.empty() ? items : std::span(scratch_).subspan(range.begin, range.size());
      const std::uint32_t left_count = part(items, scratch, executor_, [&](const Item& item) {
        return binning.bin(item, best.axis) < static_cast<int>(best.index);
      });
      return {leaf.box, range.begin + left_count};
    }
  }

  // Halve where levels are short, where all centers fall together,
  // and two primitives, which have no other split.
  const double halves_cost =
      range.size() == 2 ? items[0].reach().half_area() + items[1].reach().half_area() : area * range.size();
  if (plan == Plan::choose && !must_or_should_split(halves_cost)) return leaf;
  const std::uint32_t half = range.size() / 2;
  std::nth_element(items.begin(), items.begin() + half, items.end(),
                   ByCenter{longest_axis(around.half_centers)});
  return {leaf.box, range.begin + half};
}

void BinnedSahSplitter::write_leaf(Range range, std::span<PrimId> out) const {
  for (std::uint32_t i = 0; i < range.size(); ++i) out[i] = items_[range.begin + i].prim_id;
  std::sort(out.begin(), out.end());
}

}  // namespace boxwood
