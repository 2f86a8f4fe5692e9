#include "boxwood/build/longest_axis.h"

#include <algorithm>

namespace boxwood {

LongestAxisSplitter::LongestAxisSplitter(std::span<Item> items, const BuildOptions& options)
    : items_(items), leaf_size_(static_cast<std::uint32_t>(options.leaf_size)) {}

Step<NoShare> LongestAxisSplitter::step(Range range, Plan plan, NoShare) {
  const std::span<Item> items = items_.subspan(range.begin, range.size());
  Reach box;
  for (const Item& item : items) box.extend(item.reach());
  if (plan == Plan::leaf || range.size() <= leaf_size_) return {box.box(), range.begin, {}, {}};

  // Bring the primitives into the order of their centers along the node's longest axis.
  const int axis = longest_axis(box);
  std::sort(items.begin(), items.end(), ByCenter{axis});

  // The right group begins at the first center that is not before the middle of the box (halves, as in Item).
  const float half_middle = 0.25f * box.upper.v[axis] - 0.25f * box.minus_lower.v[axis];
  const auto right = std::partition_point(
      items.begin(), items.end(), [&](const Item& item) { return item.half_center(axis) < half_middle; });
  if (right == items.end()) return {box.box(), range.begin, {}, {}};
  return {box.box(), range.begin + static_cast<std::uint32_t>(right - items.begin()), {}, {}};
}

void LongestAxisSplitter::write_leaf(Range range, NoShare, std::span<PrimId> out) const {
  for (std::uint32_t i = 0; i < range.size(); ++i) out[i] = items_[range.begin + i].prim_id;
}

}  // namespace boxwood
