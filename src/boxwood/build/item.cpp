#include "boxwood/build/item.h"

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>

namespace boxwood {
namespace {

constexpr std::size_t kGrain = 1 << 14;

[[noreturn]] void refuse(std::span<const Box3> boxes, std::size_t i) {
  const auto text = [](Vec3 p) {
    return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")";
  };
  throw std::invalid_argument("build: box " + std::to_string(i) + " of " + std::to_string(boxes.size()) +
                              " is " + text(boxes[i].lower) + " to " + text(boxes[i].upper) +
                              ", expected finite corners or the empty box");
}

}  // namespace

Items collect_items(std::span<const Box3> boxes, Executor& executor) {
  Items items;
  items.full = RawArray<Item>(boxes.size());
  std::atomic<std::size_t> first_bad{boxes.size()};
  std::atomic<bool> any_empty{false};

  // Copy every box; remember the smallest number that must be refused.
  parallel_for(executor, 0, boxes.size(), kGrain, [&](std::size_t i) {
    const Box3& box = boxes[i];
    const bool is_finite_box = is_finite(box.lower) && is_finite(box.upper);
    if (!is_finite_box && box != Box3{}) {
      std::size_t seen = first_bad.load();
      while (i < seen && !first_bad.compare_exchange_weak(seen, i)) {
      }
    }
    if (box.is_empty()) any_empty.store(true, std::memory_order_relaxed);
    items.full[i] = Item(box, PrimId(i));
  });
  if (first_bad < boxes.size()) refuse(boxes, first_bad);

  // Take the empty ones out.
  if (any_empty) {
    for (std::size_t i = 0; i < boxes.size(); ++i)
      if (boxes[i].is_empty()) items.empty_boxes.push_back(PrimId(i));
    const auto end = std::remove_if(items.full.begin(), items.full.end(),
                                    [&](const Item& item) { return boxes[item.prim_id.value].is_empty(); });
    items.full.shrink(static_cast<std::size_t>(end - items.full.begin()));
  }
  return items;
}

}  // namespace boxwood
