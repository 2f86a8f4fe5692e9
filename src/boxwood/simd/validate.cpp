#include "boxwood/simd/validate.h"

#include <algorithm>
#include <cstring>

#include "boxwood/tree/validate.h"

namespace boxwood::simd {
namespace {

bool is_same(const Triangle& a, const Triangle& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

template <int W>
std::string check(const TriangleTree& tree) {
  // Name the triangles 0, 1, 2, ... in the order of their keys, which may have gaps.
  WideBvh<W> wide = tree.unpack<W>();
  std::vector<PrimId> keys = wide.slots;
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  for (PrimId& slot : wide.slots)
    slot =
        PrimId(static_cast<std::uint64_t>(std::lower_bound(keys.begin(), keys.end(), slot) - keys.begin()));

  // A key is one triangle, wherever it stands.
  std::vector<Triangle> triangles(keys.size());
  std::vector<bool> is_known(keys.size(), false);
  std::vector<Box3> boxes(keys.size());
  for (std::size_t b = 0; b < tree.block_count(); ++b) {
    const TriangleBlock block = tree.block(b);
    for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
      const Triangle triangle = block.triangle(lane);
      const std::uint32_t i = wide.slots[b * kBlockWidth + lane].value;
      if (is_known[i] && !is_same(triangle, triangles[i]))
        return "lane " + std::to_string(lane) + " of block " + std::to_string(b) + " has key " +
               std::to_string(keys[i].value) + ", but is another triangle than an earlier lane of that key";
      triangles[i] = triangle;
      boxes[i] = triangle.box();
      is_known[i] = true;
    }
  }
  return boxwood::validate(wide, boxes);
}

}  // namespace

std::string validate(const TriangleTree& tree) {
  return with_width(tree.width(), [&](auto w) { return check<w()>(tree); });
}

}  // namespace boxwood::simd
