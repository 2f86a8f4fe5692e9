#include "boxwood/simd/placed_trees.h"

#include <algorithm>
#include <utility>

namespace boxwood::simd {

PlacedTrees::PlacedTrees(BoxTree boxes, std::vector<PlacedTree> items)
    : boxes_(std::move(boxes)), items_(std::move(items)) {
  // An item is reached by a 32-bit offset in floats.
  constexpr std::size_t kMostItems = (std::size_t(1) << 31) / (sizeof(PlacedTree) / sizeof(float));
  is_ordinary_ = boxes_.is_ordinary() && items_.size() < kMostItems;
  for (const PlacedTree& item : items_) {
    if (!item.tree) continue;
    has_triangles_ = true;
    is_ordinary_ = is_ordinary_ && item.tree->is_ordinary();
    max_stack_ = std::max(max_stack_, item.tree->max_stack());
    layout_ = item.tree->layout();
  }
  max_stack_ += boxes_.max_stack() + 2;  // the bottoms of both levels
}

}  // namespace boxwood::simd
