#include "boxwood/build/item.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "boxwood/build/bins.h"

namespace boxwood {
namespace {

constexpr std::size_t kBlock = 1 << 13;

[[noreturn]] void refuse(std::span<const Box3> boxes, std::size_t i) {
  const auto text = [](Vec3 p) {
    return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")";
  };
  throw std::invalid_argument("build: box " + std::to_string(i) + " of " + std::to_string(boxes.size()) +
                              " is " + text(boxes[i].lower) + " to " + text(boxes[i].upper) +
                              ", expected finite corners or the empty box");
}

}  // namespace

void check_box(std::span<const Box3> boxes, std::size_t i) {
  if (!(is_finite(boxes[i].lower) && is_finite(boxes[i].upper)) && boxes[i] != Box3{}) refuse(boxes, i);
}

Items collect_items(std::span<const Box3> boxes, Executor& executor) {
  Items items;
  items.full = RawArray<Item>(boxes.size());
  const std::size_t blocks = (boxes.size() + kBlock - 1) / kBlock;
  std::vector<Bounds> bounds(blocks);
  std::vector<std::uint8_t> is_odd(blocks, 0);

  // Copy every box. A sum of zeros is 0, unless something that is not finite was multiplied by 0.
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    const std::size_t begin = block * kBlock, end = std::min(boxes.size(), begin + kBlock);
    bool are_plain = true;
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [lower, upper] = boxes[i];
      const float zero =
          (lower.x * 0 + lower.y * 0) + (lower.z * 0 + upper.x * 0) + (upper.y * 0 + upper.z * 0);
      are_plain &= (zero == 0) & (lower.x <= upper.x) & (lower.y <= upper.y) & (lower.z <= upper.z);
      items.full[i] = Item(boxes[i], PrimId(i));
    }
    is_odd[block] = !are_plain;
    if (are_plain) bin_kernels().bound(bounds[block], {items.full.data() + begin, end - begin});
  });

  // Take the empty ones out, and refuse the first that is neither full nor empty.
  if (std::find(is_odd.begin(), is_odd.end(), 1) != is_odd.end()) {
    std::size_t full = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      check_box(boxes, i);
      if (boxes[i].is_empty())
        items.empty_boxes.push_back(PrimId(i));
      else
        items.full[full++] = items.full[i];
    }
    items.full.shrink(full);
    bin_kernels().bound(items.bounds, {items.full.data(), full});
  } else {
    for (const Bounds& some : bounds) items.bounds.extend(some);
  }
  return items;
}

}  // namespace boxwood
