// node-inl.h: which children of a node does a ray enter, and in which order? Compiled once for each
// instruction set (kernels.cpp).

#if defined(BOXWOOD_SIMD_NODE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_NODE_INL_H
#undef BOXWOOD_SIMD_NODE_INL_H
#else
#define BOXWOOD_SIMD_NODE_INL_H
#endif

#include "boxwood/simd/layout-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

/// The part of the ray inside each child: bits of floats that are not negative order as the floats do, so the
/// largest and smallest are found among integers, which takes a quarter of the time. A negative entry gives
/// way to t_min, and a negative exit stays the smallest.
struct Slabs {
  VIW entry;
  hn::Mask<DIW> enters;
};

/// The constants of a ray for boxes, in vectors. A ray below a placement may have negative t (kSigned), where
/// floats must be compared as floats.
template <bool kSigned>
struct BoxRay {
  VW inverse[3], near_shift[3], far_shift[3], t_min;
  std::ptrdiff_t near_row[3], far_row[3];

  HWY_INLINE explicit BoxRay(const KernelRay& ray) {
    const DW d;
    for (int k = 0; k < 3; ++k) {
      inverse[k] = hn::Set(d, ray.inverse[k]);
      near_shift[k] = hn::Set(d, ray.near_shift[k]);
      far_shift[k] = hn::Set(d, ray.far_shift[k]);
      near_row[k] = ray.near_row[k];
      far_row[k] = ray.far_row[k];
    }
    t_min = hn::Set(d, ray.t_min);
  }

  template <class Layout>
  HWY_INLINE Slabs cross(const char* node, float limit) const {
    const DW d;
    const DIW di;
    const typename Layout::Planes planes(node);
    const auto near = [&](int k) {
      return hn::MulAdd(planes.row(k, near_row[k]), inverse[k], near_shift[k]);
    };
    const auto far = [&](int k) { return hn::MulAdd(planes.row(k, far_row[k]), inverse[k], far_shift[k]); };
    if constexpr (kSigned) {
      const VW entry = hn::Max(hn::Max(near(0), near(1)), hn::Max(near(2), t_min));
      const VW exit = hn::Min(hn::Min(far(0), far(1)), hn::Min(far(2), hn::Set(d, limit)));
      return {hn::BitCast(di, hn::Max(entry, hn::Zero(d))), hn::RebindMask(di, hn::Le(entry, exit))};
    }
    const auto bits = [&](VW v) { return hn::BitCast(di, v); };
    const VIW entry = hn::Max(hn::Max(bits(near(0)), bits(near(1))), hn::Max(bits(near(2)), bits(t_min)));
    const VIW exit =
        hn::Min(hn::Min(bits(far(0)), bits(far(1))), hn::Min(bits(far(2)), bits(hn::Set(d, limit))));
    return {entry, hn::RebindMask(di, hn::Le(hn::BitCast(d, entry), hn::BitCast(d, exit)))};
  }
};

/// A key orders children by entry and says which child it is: the entry's lowest bits make way for the
/// number. This makes a distance smaller at most, which culls less.
inline constexpr std::int32_t kChildBits = kWidth > 8 ? 15 : 7;
HWY_INLINE VIW make_keys(VIW entry) {
  const DIW di;
  return hn::Or(hn::AndNot(hn::Set(di, kChildBits), entry), hn::Iota(di, 0));
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

/// Sorts eight keys, the largest first: two fours, one of them turned round, merged (Batcher, "Sorting
/// Networks and Their Applications", 1968).
template <class D>
HWY_INLINE hn::Vec<D> sort_eight_descending(D d, hn::Vec<D> keys) {
  using V = hn::Vec<D>;
  const hn::Repartition<std::int64_t, D> d64;
  // The larger of each pair goes to even lanes, or to even pairs of lanes.
  const auto by_one = [&](V a, V b) { return hn::OddEven(hn::Min(a, b), hn::Max(a, b)); };
  const auto by_two = [&](V a, V b) {
    return hn::BitCast(d, hn::OddEven(hn::BitCast(d64, hn::Min(a, b)), hn::BitCast(d64, hn::Max(a, b))));
  };
  keys = by_one(keys, hn::Shuffle2301(keys));
  keys = by_two(keys, hn::Shuffle0123(keys));
  keys = by_one(keys, hn::Shuffle2301(keys));
  const V turned = hn::Reverse(d, keys);
  keys = hn::ConcatUpperLower(d, hn::Min(keys, turned), hn::Max(keys, turned));
  keys = by_two(keys, hn::Shuffle1032(keys));
  return by_one(keys, hn::Shuffle2301(keys));
}

/// Sorts sixteen keys, the largest first: two eights, merged the same way.
template <class D>
HWY_INLINE hn::Vec<D> sort_sixteen_descending(D d, hn::Vec<D> keys) {
  const hn::Half<D> half;
  const auto lower = sort_eight_descending(half, hn::LowerHalf(half, keys));
  const auto upper = hn::Reverse(half, sort_eight_descending(half, hn::UpperHalf(half, keys)));
  // Each half is first high then low, or the other way round; what remains is sorted by distances 4, 2, 1.
  const auto merge = [&](auto v) {
    const auto swapped = hn::ConcatLowerUpper(half, v, v);
    v = hn::ConcatUpperLower(half, hn::Min(v, swapped), hn::Max(v, swapped));
    const hn::Repartition<std::int64_t, hn::Half<D>> half64;
    const auto by_two = [&](auto a, auto b) {
      return hn::BitCast(half,
                         hn::OddEven(hn::BitCast(half64, hn::Min(a, b)), hn::BitCast(half64, hn::Max(a, b))));
    };
    v = by_two(v, hn::Shuffle1032(v));
    const auto other = hn::Shuffle2301(v);
    return hn::OddEven(hn::Min(v, other), hn::Max(v, other));
  };
  return hn::Combine(d, merge(hn::Min(lower, upper)), merge(hn::Max(lower, upper)));
}

/// Sorts the keys of all children, the largest first.
template <class D>
HWY_INLINE hn::Vec<D> sort_all_descending(D d, hn::Vec<D> keys) {
  if constexpr (kWidth == 4)
    return sort_descending(keys);
  else if constexpr (kWidth == 8)
    return sort_eight_descending(d, keys);
  else
    return sort_sixteen_descending(d, keys);
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
