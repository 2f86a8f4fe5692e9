#include "support/random_tree.h"

#include <utility>

#include "boxwood/core/random.h"

namespace boxwood::test {
namespace {

class Maker {
 public:
  Maker(std::span<const Box3> boxes, std::uint32_t leaf_size, std::uint64_t seed)
      : boxes_(boxes), leaf_size_(leaf_size), random_(seed) {}

  Bvh make() {
    const auto count = static_cast<std::uint32_t>(boxes_.size());
    if (count == 0) return {};
    for (std::uint32_t i = 0; i < count; ++i) bvh_.prim_ids.push_back(PrimId(i));
    for (std::uint32_t i = count; i > 1; --i)
      std::swap(bvh_.prim_ids[i - 1], bvh_.prim_ids[random_.below(i)]);
    for (const Box3& box : boxes_) root_.extend(box);
    bvh_.nodes.resize(1);
    split(0, 0, count, 0);
    bvh_.nodes[0].box = root_;
    return std::move(bvh_);
  }

 private:
  /// Fills the node and all below it; returns its box.
  Box3 split(std::uint32_t node_index, std::uint32_t begin, std::uint32_t end, int depth) {
    const std::uint32_t count = end - begin;
    Box3 box;
    if (count <= leaf_size_ && (count == 1 || random_.below(2) == 0)) {
      for (std::uint32_t i = begin; i < end; ++i) box.extend(boxes_[bvh_.prim_ids[i].value]);
      bvh_.nodes[node_index] = {inflated(box), begin, count};
    } else {
      // Anywhere near the root, in the middle far below it, so that the depth stays within kMaxDepth.
      const std::uint32_t middle = depth < 40 ? begin + 1 + random_.below(count - 1) : begin + count / 2;
      const auto left = static_cast<std::uint32_t>(bvh_.nodes.size());
      bvh_.nodes.resize(left + 2);
      box.extend(split(left, begin, middle, depth + 1));
      box.extend(split(left + 1, middle, end, depth + 1));
      bvh_.nodes[node_index] = {inflated(box), left, 0};
    }
    return bvh_.nodes[node_index].box;
  }

  Box3 inflated(Box3 box) {
    if (box.is_empty()) return box;
    for (int corner = 0; corner < 2; ++corner) {
      if (random_.below(2) == 0) continue;
      const Vec3 far = corner ? root_.upper : root_.lower;
      box.extend((corner ? box.upper : box.lower) * 0.75f + far * 0.25f);
    }
    return intersect(box, root_);
  }

  std::span<const Box3> boxes_;
  std::uint32_t leaf_size_;
  Random random_;
  Box3 root_;
  Bvh bvh_;
};

}  // namespace

Bvh random_tree(std::span<const Box3> boxes, std::uint32_t leaf_size, std::uint64_t seed) {
  return Maker(boxes, leaf_size, seed).make();
}

}  // namespace boxwood::test
