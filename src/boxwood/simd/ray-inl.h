// ray-inl.h: what does a kernel know about a ray? Compiled once for each instruction set (kernels.cpp).
//
// The constants of core/prepared_ray.h, worked out by vectors with the same operations and so the same bits;
// and a second pair of shifts for boxes. A box test may fuse multiply and add, because it only has to be
// conservative: its slack is half as large again or more (TriangleTree::box_slack), which is more than fusing
// can change, so a box is never left earlier nor entered later than the unfused interval of any box inside
// it, and the law of shape/gate.h holds.
//
// Kernels take ordinary rays only: finite, and of a size at which nothing in a leaf test can overflow. The
// rest is rare and goes to plain C++ (scene/walk.h over query/traverse_wide.h).

#if defined(BOXWOOD_SIMD_RAY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_RAY_INL_H
#undef BOXWOOD_SIMD_RAY_INL_H
#else
#define BOXWOOD_SIMD_RAY_INL_H
#endif

#include <bit>

#include <hwy/highway.h>

#include "boxwood/core/prepared_ray.h"
#include "boxwood/simd/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_NEON || HWY_TARGET == HWY_WASM
inline constexpr int kWidth = 4;  // children of a node: one vector
#elif HWY_TARGET == HWY_AVX3
inline constexpr int kWidth = 16;
#else
inline constexpr int kWidth = 8;
#endif
inline constexpr std::int32_t kRowBytes = 4 * kWidth;

/// Of the largest component; for a smaller one a leaf test could overflow, as beyond kLargestReach.
inline constexpr float kSmallestDirection = 0x1p-30f;

using D4 = hn::FixedTag<float, 4>;
using DI4 = hn::FixedTag<std::int32_t, 4>;
using V4 = hn::Vec<D4>;

/// Arrays have a fourth lane that means nothing, so that a vector can be stored whole.
struct alignas(64) KernelRay {
  // For boxes: as for PreparedRay, with the larger slack, and where the near and far planes lie in a node, in
  // bytes.
  float inverse[4];
  float near_shift[4], far_shift[4];
  std::int32_t near_row[4], far_row[4];

  // For leaves: axes in the order of the triangle test, whose rows lie at axis_row in a block.
  float origin[4];
  float shear[4];  // x, y, z
  float gate_near_shift[4], gate_far_shift[4];
  std::int32_t axis_row[4];
  float t_min;

  RayShear shear_constants() const {
    RayShear s;
    const int axes[3] = {axis_row[0] / 16, axis_row[1] / 16, axis_row[2] / 16};
    for (int k = 0; k < 3; ++k) s.origin[axes[k]] = origin[k];
    s.axis_x = axes[0];
    s.axis_y = axes[1];
    s.axis_z = axes[2];
    s.shear_x = shear[0];
    s.shear_y = shear[1];
    s.shear_z = shear[2];
    return s;
  }
};

/// Positions in the three orders of axes, for permuting and for rows of a block.
alignas(16) inline constexpr std::int32_t kAxes[3][4] = {{1, 2, 0, 3}, {2, 0, 1, 3}, {0, 1, 2, 3}};
alignas(16) inline constexpr std::int32_t kAxisRows[3][4] = {{16, 32, 0, 0}, {32, 0, 16, 0}, {0, 16, 32, 0}};

/// The lanes x, y, z of (x, y, z, anything), and 0.
HWY_INLINE V4 without_fourth(V4 v) {
  return hn::IfThenElseZero(hn::FirstN(D4(), 3), v);
}

/// The largest lane, in all of them.
HWY_INLINE V4 largest(V4 v) {
  v = hn::Max(v, hn::Shuffle2301(v));
  return hn::Max(v, hn::Shuffle1032(v));
}

/// Prepares `ray` for a tree inside `bounds` (TriangleTree::is_ordinary()) whose boxes need `box_slack`;
/// false when the ray is not ordinary. Its t_min counts as 0 where it is negative, but below a placement
/// (kSigned).
template <bool kSigned = false>
HWY_INLINE bool prepare(const Ray& ray, const Box3& bounds, float box_slack, KernelRay& out) {
  const D4 d;
  const DI4 di;
  const V4 o = without_fourth(hn::LoadU(d, &ray.origin.x)),
           dir = without_fourth(hn::LoadU(d, &ray.direction.x));
  const V4 abs_o = hn::Abs(o), abs_dir = hn::Abs(dir);
  const V4 d_max = largest(abs_dir);

  // How far away things can be.
  const V4 lower = without_fourth(hn::LoadU(d, &bounds.lower.x));
  const V4 upper = without_fourth(hn::Shuffle0321(hn::LoadU(d, &bounds.lower.z)));
  const V4 to_corner = hn::Max(hn::Abs(hn::Sub(lower, o)), hn::Abs(hn::Sub(upper, o)));
  const V4 reach = largest(to_corner);

  // Whether the ray is ordinary: comparisons with NaN are false, and a sum keeps one.
  const float t_min = !kSigned && ray.t_min < 0 ? 0.0f : ray.t_min;
  const auto is_ordinary = hn::And(hn::Le(hn::Add(abs_dir, to_corner), hn::Set(d, kLargestReach)),
                                   hn::Ge(d_max, hn::Set(d, kSmallestDirection)));
  if (HWY_UNLIKELY(!hn::AllTrue(d, is_ordinary) || !(ray.t_max >= t_min))) return false;

  // The slabs: see core/prepared_ray.h.
  constexpr float u = 0x1p-24f;
  const V4 least = hn::Mul(d_max, hn::Set(d, 0x1p-30f)), tiny = hn::Set(d, 0x1p-140f);
  const V4 r = hn::Div(hn::Set(d, 1.0f), hn::CopySign(hn::Max(abs_dir, least), dir));
  const V4 error = hn::Add(hn::Mul(hn::Set(d, 12 * u), reach), hn::Mul(hn::Set(d, 8 * u), abs_o));
  const V4 slack = hn::Add(hn::Mul(hn::Abs(r), hn::Add(error, tiny)), tiny);
  const V4 wide_slack = hn::Add(hn::Mul(slack, hn::Set(d, box_slack)), hn::Set(d, 0x1p-120f));
  const V4 shift = hn::Neg(hn::Mul(o, r));
  hn::Store(r, d, out.inverse);
  hn::Store(hn::Sub(shift, wide_slack), d, out.near_shift);
  hn::Store(hn::Add(shift, wide_slack), d, out.far_shift);
  hn::Store(hn::Sub(shift, slack), d, out.gate_near_shift);
  hn::Store(hn::Add(shift, slack), d, out.gate_far_shift);
  HWY_ALIGN constexpr std::int32_t kLowerRows[4] = {0, 2 * kRowBytes, 4 * kRowBytes, 0};
  const auto is_backward = hn::BroadcastSignBit(hn::BitCast(di, dir));
  const auto near_row = hn::Add(hn::Load(di, kLowerRows), hn::And(is_backward, hn::Set(di, kRowBytes)));
  hn::Store(near_row, di, out.near_row);
  hn::Store(hn::Xor(near_row, hn::Set(di, kRowBytes)), di, out.far_row);

  // The shear: see shape/triangle.h. 1 / d on the longest axis is there already.
  const int z = longest_axis(abs(ray.direction));
  const auto order = hn::SetTableIndices(d, kAxes[z]);
  const V4 rz = hn::Broadcast<2>(hn::TableLookupLanes(r, order));
  const V4 sheared = hn::Mul(hn::TableLookupLanes(dir, order), rz);
  hn::Store(hn::TableLookupLanes(o, order), d, out.origin);
  hn::Store(hn::ConcatUpperLower(d, rz, sheared), d, out.shear);
  hn::Store(hn::Load(di, kAxisRows[z]), di, out.axis_row);
  out.t_min = t_min + 0.0f;
  return true;
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
