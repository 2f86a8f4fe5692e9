#include "boxwood/build/binned_sah.h"

#include <algorithm>
#include <cmath>

namespace boxwood {
namespace {

/// Which bin a half center falls into, on each axis: monotonic in the center, so that bins are slabs in
/// order.
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

  explicit Histogram(int bins) {
    for (int k = 0; k < 3; ++k) {
      std::fill_n(reach[k], bins, Reach{});
      std::fill_n(count[k], bins, 0);
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

/// Prices every plane between two bins that leaves something on both sides; `index` is the first bin on the
/// right.
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

}  // namespace

BinnedSahSplitter::BinnedSahSplitter(std::vector<Item>& items, const BuildOptions& options)
    : items_(items),
      leaf_size_(static_cast<std::uint32_t>(options.leaf_size)),
      max_bins_(options.bins),
      cost_{options.traversal_cost} {}

Step BinnedSahSplitter::step(Range range, Plan plan) {
  const std::span<Item> items = items_.subspan(range.begin, range.size());
  const Extents around = extents(items);
  const Step leaf{around.box.box(), range.begin};
  if (plan == Plan::leaf) return leaf;

  if (plan == Plan::choose) {
    // Fill the bins. More bins than primitives cost time and tell nothing.
    const int bins =
        std::min<int>(max_bins_, std::max<int>(4, static_cast<int>(std::min(64u, range.size()))));
    const Binning binning(around.half_centers, bins);
    Histogram histogram(bins);
    histogram.add(binning, items);
    const Split best = find_best_split(histogram, binning, range.size());

    // A small range stays together unless taking it apart pays.
    const double area = around.box.half_area();
    const bool split_pays =
        best.exists() && cost_.split(area, best.children_cost) < SahCost::leaf(area, range.size());
    if (range.size() <= leaf_size_ && !split_pays) return leaf;

    if (best.exists()) {
      const auto right = std::partition(items.begin(), items.end(), [&](const Item& item) {
        return binning.bin(item, best.axis) < static_cast<int>(best.index);
      });
      return {leaf.box, range.begin + static_cast<std::uint32_t>(right - items.begin())};
    }
  }

  // Halve where the driver asks for it, or where all centers fall together.
  const auto middle = items.begin() + range.size() / 2;
  std::nth_element(items.begin(), middle, items.end(), ByCenter{longest_axis(around.half_centers)});
  return {leaf.box, range.begin + range.size() / 2};
}

void BinnedSahSplitter::write_leaf(Range range, std::span<PrimId> out) const {
  for (std::uint32_t i = 0; i < range.size(); ++i) out[i] = items_[range.begin + i].prim_id;
  std::sort(out.begin(), out.end());
}

}  // namespace boxwood
