// boxes-inl.h: which boxes of a BoxTree does a ray enter, nearest first? Compiled once for each instruction
// set (kernels.cpp).

#if defined(BOXWOOD_SIMD_BOXES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_BOXES_INL_H
#undef BOXWOOD_SIMD_BOXES_INL_H
#else
#define BOXWOOD_SIMD_BOXES_INL_H
#endif

#include "boxwood/simd/box_tree.h"
#include "boxwood/simd/single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

/// Calls visitor.visit(item) for the items whose boxes the ray enters before `limit`, then before what
/// visit() returned last; begins at `current`.
template <class Visitor>
HWY_NOINLINE void visit_boxes_one(const char* pool, std::uint32_t current, const KernelRay& ray, float limit,
                                  Visitor& visitor) {
  const DIW di;
  const BoxRay<false> box_ray(ray);
  HWY_ALIGN std::int32_t keys[kStackSize], refs[kStackSize];
  keys[0] = std::numeric_limits<std::int32_t>::min();  // below every limit
  refs[0] = static_cast<std::int32_t>(kBottom);
  std::size_t top = 0;
  while (current != kBottom) {
    if ((current & 3) == 0) {
      const char* node = node_at(pool, current);
      const std::int32_t* children = children_of<FullLayout>(node);
      const Slabs slabs = box_ray.template cross<FullLayout>(node, limit);
      const std::uint32_t bits = mask_bits(di, slabs.enters);
      if (bits != 0) {
        if ((bits & (bits - 1)) == 0) {
          current = static_cast<std::uint32_t>(children[__builtin_ctz(bits)]);
          continue;
        }
        const auto count = static_cast<std::size_t>(__builtin_popcount(bits));
        push_children(di, make_keys(slabs.entry), slabs.enters, children, count, keys + top + 1,
                      refs + top + 1);
        top += count - 1;
        current = static_cast<std::uint32_t>(refs[top + 1]);
        continue;
      }
    } else {
      limit = visitor.visit(BoxTree::item_of(current));
    }
    const std::int32_t limit_key = std::bit_cast<std::int32_t>(limit) | kChildBits;
    while (keys[top] > limit_key) --top;
    current = static_cast<std::uint32_t>(refs[top]);
    if (top > 0) --top;
  }
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
