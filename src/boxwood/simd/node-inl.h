// node-inl.h: which children of a node does a ray enter, and in which order? Compiled once for each
// instruction set (kernels.cpp).

#if defined(BOXWOOD_SIMD_NODE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_NODE_INL_H
#undef BOXWOOD_SIMD_NODE_INL_H
#else
#define BOXWOOD_SIMD_NODE_INL_H
#endif

#include "boxwood/simd/ray-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

using DW = hn::FixedTag<float, kWidth>;
using DIW = hn::FixedTag<std::int32_t, kWidth>;
using VW = hn::Vec<DW>;
using VIW = hn::Vec<DIW>;

/// The part of the ray inside each child: bits of floats that are not negative order as the floats do, so the
/// largest and smallest are found among integers, which takes a quarter of the time. A negative entry gives
/// way to t_min, and a negative exit stays the smallest.
struct Slabs {
  VIW entry;
  hn::Mask<DIW> enters;
};

HWY_INLINE Slabs cross_slabs(const char* node, const KernelRay& ray, float limit) {
  const DW d;
  const DIW di;
  const auto cross = [&](int axis, const std::int32_t* rows, const float* shift) {
    const VW planes = hn::Load(d, reinterpret_cast<const float*>(node + rows[axis]));
    return hn::BitCast(di, hn::MulAdd(planes, hn::Set(d, ray.inverse[axis]), hn::Set(d, shift[axis])));
  };
  const VIW entry =
      hn::Max(hn::Max(cross(0, ray.near_row, ray.near_shift), cross(1, ray.near_row, ray.near_shift)),
              hn::Max(cross(2, ray.near_row, ray.near_shift), hn::BitCast(di, hn::Set(d, ray.t_min))));
  const VIW exit =
      hn::Min(hn::Min(cross(0, ray.far_row, ray.far_shift), cross(1, ray.far_row, ray.far_shift)),
              hn::Min(cross(2, ray.far_row, ray.far_shift), hn::BitCast(di, hn::Set(d, limit))));
  return {entry, hn::RebindMask(di, hn::Le(hn::BitCast(d, entry), hn::BitCast(d, exit)))};
}

/// A key orders children by entry and says which child it is: the entry's lowest three bits make way for the
/// number. This makes a distance smaller at most, which culls less.
HWY_INLINE VIW make_keys(VIW entry) {
  const DIW di;
  return hn::Or(hn::AndNot(hn::Set(di, 7), entry), hn::Iota(di, 0));
}

/// Sorts four keys, the largest first.
HWY_INLINE hn::Vec<DI4> sort_descending(hn::Vec<DI4> keys) {
  const DI4 d;
  hn::Vec<DI4> other = hn::Shuffle2301(keys);
  keys = hn::OddEven(hn::Min(keys, other), hn::Max(keys, other));
  other = hn::Shuffle0123(keys);
  keys = hn::ConcatUpperLower(d, hn::Min(keys, other), hn::Max(keys, other));
  other = hn::Shuffle2301(keys);
  return hn::OddEven(hn::Min(keys, other), hn::Max(keys, other));
}

HWY_INLINE void prefetch_lines(const char* p) {
  __builtin_prefetch(p);
  __builtin_prefetch(p + 64);
  if (kWidth == 8) {
    __builtin_prefetch(p + 128);
    __builtin_prefetch(p + 192);
  }
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
