#include "boxwood/build/item.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "boxwood/build/bins.h"

namespace boxwood {
namespace {

constexpr std::size_t kBlock = 1 << 13;

[[noreturn]] void refuse(const Box3& box, std::size_t i, std::size_t count) {
  const auto text = [](Vec3 p) {
    return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")";
  };
  throw std::invalid_argument("build: box " + std::to_string(i) + " of " + std::to_string(count) + " is " +
                              text(box.lower) + " to " + text(box.upper) +
                              ", expected finite corners or the empty box");
}
void check(const Box3& box, std::size_t i, std::size_t count) {
  if (!(is_finite(box.lower) && is_finite(box.upper)) && box != Box3{}) refuse(box, i, count);
}

}  // namespace

void check_box(std::span<const Box3> boxes, std::size_t i) {
  check(boxes[i], i, boxes.size());
}

Items collect_items(std::size_t count, const BoxSource& source, Executor& executor) {
  Items items;
  items.full = RawArray<Item>(count);
  const std::size_t blocks = (count + kBlock - 1) / kBlock;
  std::vector<Bounds> bounds(blocks);
  std::vector<std::uint8_t> is_odd(blocks, 0);

  // Note every box. A sum of zeros is 0, unless something that is not finite was multiplied by 0.
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    Box3 boxes[kSourceBlock];
    bool are_plain = true;
    const std::size_t block_end = std::min(count, (block + 1) * kBlock);
    for (std::size_t begin = block * kBlock, end; begin < block_end; begin = end) {
      end = std::min(block_end, begin + kSourceBlock);
      source(begin, end, boxes);
      for (std::size_t i = begin; i < end; ++i) {
        const auto& [lower, upper] = boxes[i - begin];
        const float zero =
            (lower.x * 0 + lower.y * 0) + (lower.z * 0 + upper.x * 0) + (upper.y * 0 + upper.z * 0);
        are_plain &= (zero == 0) & (lower.x <= upper.x) & (lower.y <= upper.y) & (lower.z <= upper.z);
        items.full[i] = Item(boxes[i - begin], PrimId(i));
      }
      if (are_plain) bin_kernels().bound(bounds[block], {items.full.data() + begin, end - begin});
    }
    is_odd[block] = !are_plain;
  });

  // Take the empty ones out, and refuse the first that is neither full nor empty.
  if (std::find(is_odd.begin(), is_odd.end(), 1) != is_odd.end()) {
    std::size_t full = 0;
    for (std::size_t i = 0; i < count; ++i) {
      Box3 box;
      source(i, i + 1, &box);
      check(box, i, count);
      if (box.is_empty())
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
