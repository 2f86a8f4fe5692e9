// lanes-inl.h: which lanes does a mask name? Compiled once for each instruction set (kernels.cpp).
//
// Two steps that a kernel takes at every node, and that the SIMD library has no fast form of everywhere: its
// own Compress copies a table to the stack at each call when gcc compiles it for AVX2 or SSE4.

#if defined(BOXWOOD_SIMD_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_LANES_INL_H
#undef BOXWOOD_SIMD_LANES_INL_H
#else
#define BOXWOOD_SIMD_LANES_INL_H
#endif

#include <cstdint>

#include "boxwood/simd/ray-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

/// The lanes of a mask of up to sixteen, as bits.
template <class D, class M>
HWY_INLINE std::uint32_t mask_bits(D d, M mask) {
  if constexpr (hn::MaxLanes(D()) > 8) {
    std::uint16_t bits = 0;
    hn::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&bits));
    return bits;
  } else {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    return bits[0];
  }
}

#if HWY_TARGET > HWY_AVX3
/// For each mask of kWidth lanes: where the lanes stand afterwards, those of the mask first. In units of
/// kUnit bytes, as the instruction wants them.
struct CompressTable {
  static constexpr int kUnit = kWidth == 8 ? 4 : 1;
  static constexpr int kUnitsPerLane = 4 / kUnit;
  alignas(16) std::uint8_t from[1 << kWidth][kWidth * kUnitsPerLane] = {};

  constexpr CompressTable() {
    for (int bits = 0; bits < 1 << kWidth; ++bits) {
      int at = 0;
      for (const bool is_set : {true, false})
        for (int lane = 0; lane < kWidth; ++lane)
          if ((bits >> lane & 1) == is_set)
            for (int unit = 0; unit < kUnitsPerLane; ++unit)
              from[bits][at++] = static_cast<std::uint8_t>(lane * kUnitsPerLane + unit);
    }
  }
};
inline constexpr CompressTable kCompressTable;
#endif

/// Moves the lanes of `mask` to the front, in their order; the others follow, or are 0.
template <class D, class M>
HWY_INLINE hn::Vec<D> compress(D d, hn::Vec<D> v, M mask) {
#if HWY_TARGET <= HWY_AVX3
  (void)d;
  return hn::Compress(v, mask);
#else
  const std::uint8_t* from = kCompressTable.from[mask_bits(d, mask)];
  if constexpr (kWidth == 8) {
    const auto lanes = hn::PromoteTo(d, hn::LoadU(hn::Rebind<std::uint8_t, D>(), from));
    return hn::TableLookupLanes(v, hn::IndicesFromVec(d, lanes));
  } else {
    const hn::Repartition<std::uint8_t, D> bytes;
    return hn::BitCast(d, hn::TableLookupBytes(hn::BitCast(bytes, v), hn::Load(bytes, from)));
  }
#endif
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
