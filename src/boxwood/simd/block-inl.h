// block-inl.h: does a ray cross the triangles of a block? Compiled once for each instruction set
// (kernels.cpp).
//
// shape/triangle.h and shape/gate.h for four triangles at once: the same operations in the same order, so the
// same bits. Lanes that float cannot decide (see there) are asked one by one of the scalar test itself. In
// two parts, so that a kernel can do something else in between: most blocks end with the first.

#if defined(BOXWOOD_SIMD_BLOCK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_BLOCK_INL_H
#undef BOXWOOD_SIMD_BLOCK_INL_H
#else
#define BOXWOOD_SIMD_BLOCK_INL_H
#endif

#include "boxwood/simd/lanes-inl.h"
#include "boxwood/simd/triangle_tree.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

/// Lanes that the ray's line may cross, and of those the ones that it crosses for sure, as bits.
struct Crossed {
  std::uint32_t maybe, surely;
};

/// The edge functions opposite to the vertices a, b, c, and what their signs say.
struct Edges {
  V4 wa, wb, wc;
  Crossed crossed;
};
HWY_INLINE Edges test_edges(const TriangleBlock& block, const KernelRay& ray) {
  const D4 d;
  const char* rows = reinterpret_cast<const char*>(&block);
  const char *x = rows + ray.axis_row[0], *y = rows + ray.axis_row[1], *z = rows + ray.axis_row[2];
  const auto row = [&](const char* axis, int vertex) {
    return hn::Load(d, reinterpret_cast<const float*>(axis + 48 * vertex));
  };

  // Move the vertices so that the ray starts at 0 and runs along z. The differences are taken the other way
  // round, origin - vertex, which changes all signs and nothing else: products of two are the same.
  const V4 ox = hn::Set(d, ray.origin[0]), oy = hn::Set(d, ray.origin[1]), oz = hn::Set(d, ray.origin[2]);
  const V4 sx = hn::Set(d, ray.shear[0]), sy = hn::Set(d, ray.shear[1]);
  const V4 az = hn::Sub(oz, row(z, 0)), bz = hn::Sub(oz, row(z, 1)), cz = hn::Sub(oz, row(z, 2));
  const V4 ax = hn::Sub(hn::Sub(ox, row(x, 0)), hn::Mul(sx, az)),
           ay = hn::Sub(hn::Sub(oy, row(y, 0)), hn::Mul(sy, az));
  const V4 bx = hn::Sub(hn::Sub(ox, row(x, 1)), hn::Mul(sx, bz)),
           by = hn::Sub(hn::Sub(oy, row(y, 1)), hn::Mul(sy, bz));
  const V4 cx = hn::Sub(hn::Sub(ox, row(x, 2)), hn::Mul(sx, cz)),
           cy = hn::Sub(hn::Sub(oy, row(y, 2)), hn::Mul(sy, cz));

  // Where two signs differ the product is negative and the triangle is missed.
  const V4 wa = hn::Sub(hn::Mul(bx, cy), hn::Mul(by, cx));
  const V4 wb = hn::Sub(hn::Mul(cx, ay), hn::Mul(cy, ax));
  const V4 wc = hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx));
  const V4 product = hn::Mul(hn::Min(wa, hn::Min(wb, wc)), hn::Max(wa, hn::Max(wb, wc)));
  const auto missed = hn::Lt(product, hn::Zero(d));
  return {wa, wb, wc, {mask_bits(d, missed) ^ 15u, mask_bits(d, hn::Gt(product, hn::Zero(d)))}};
}

/// Asks the scalar test about each lane of `lanes`; returns those that are crossed, before any gate.
HWY_NOINLINE inline std::uint32_t resolve_lanes(const TriangleBlock& block, const KernelRay& ray,
                                                std::uint32_t lanes, float* t) {
  const RayShear shear = ray.shear_constants();
  std::uint32_t crossed = 0;
  for (; lanes; lanes &= lanes - 1) {
    const auto lane = static_cast<std::uint32_t>(__builtin_ctz(lanes));
    const Triangle triangle = block.triangle(lane);
    Crossing crossing;
    if (!intersect_triangle(shear, triangle.a, triangle.b, triangle.c, crossing)) continue;
    t[lane] = crossing.t;
    crossed |= 1u << lane;
  }
  return crossed;
}

/// Of the lanes of `crossed`, those that count as crossed at a t in [ray.t_min, limit]; their t in `ts`.
HWY_INLINE std::uint32_t test_planes(const TriangleBlock& block, const KernelRay& ray, Crossed crossed,
                                     float limit, float* HWY_RESTRICT ts) {
  const D4 d;
  const char* rows = reinterpret_cast<const char*>(&block);
  const char *x = rows + ray.axis_row[0], *y = rows + ray.axis_row[1], *z = rows + ray.axis_row[2];
  const auto row = [&](const char* axis, int vertex) {
    return hn::Load(d, reinterpret_cast<const float*>(axis + 48 * vertex));
  };

  // Where the line meets the plane. (height has the other sign, as all differences from the origin, and so
  // has sz.)
  const V4 sx = hn::Set(d, ray.shear[0]), sy = hn::Set(d, ray.shear[1]), minus_sz = hn::Set(d, -ray.shear[2]);
  const V4 ax = row(x, 0), ay = row(y, 0), az = row(z, 0);
  const V4 e1x = hn::Sub(row(x, 1), ax), e1y = hn::Sub(row(y, 1), ay), e1z = hn::Sub(row(z, 1), az);
  const V4 e2x = hn::Sub(row(x, 2), ax), e2y = hn::Sub(row(y, 2), ay), e2z = hn::Sub(row(z, 2), az);
  const V4 yz = hn::Mul(e1y, e2z), zy = hn::Mul(e1z, e2y), zx = hn::Mul(e1z, e2x), xz = hn::Mul(e1x, e2z),
           xy = hn::Mul(e1x, e2y), yx = hn::Mul(e1y, e2x);
  const V4 nx = hn::Sub(yz, zy), ny = hn::Sub(zx, xz), nz = hn::Sub(xy, yx);
  const V4 products = hn::Add(hn::Add(hn::Add(hn::Abs(yz), hn::Abs(zy)), hn::Add(hn::Abs(zx), hn::Abs(xz))),
                              hn::Add(hn::Abs(xy), hn::Abs(yx)));
  const V4 tx = hn::Sub(hn::Set(d, ray.origin[0]), ax), ty = hn::Sub(hn::Set(d, ray.origin[1]), ay),
           tz = hn::Sub(hn::Set(d, ray.origin[2]), az);
  const V4 height = hn::Add(hn::Add(hn::Mul(nx, tx), hn::Mul(ny, ty)), hn::Mul(nz, tz));
  const V4 slope = hn::Add(hn::Add(hn::Mul(nx, sx), hn::Mul(ny, sy)), nz);
  V4 t = hn::Add(hn::Div(hn::Mul(minus_sz, height), slope), hn::Zero(d));

  // What the scalar test would take through its exact branches goes there.
  const V4 edge_on = hn::Max(hn::Mul(products, hn::Set(d, kEdgeOn)), hn::Set(d, 0x1p-80f));
  const auto ordinary = hn::And(hn::Lt(hn::Abs(t), hn::Set(d, kInfinity)), hn::Gt(hn::Abs(slope), edge_on));
  std::uint32_t lanes = crossed.surely & mask_bits(d, ordinary);
  if (HWY_UNLIKELY(lanes != crossed.maybe)) {
    hn::Store(t, d, ts);
    lanes |= resolve_lanes(block, ray, crossed.maybe & ~lanes, ts);
    t = hn::Load(d, ts);
  }

  // The gate: t is moved into the interval of the triangle's box. Rounding is monotonic, so the product of
  // the least coordinate is the least of the products.
  V4 entry = hn::Set(d, -kInfinity), exit = hn::Set(d, kInfinity);
  for (int k = 0; k < 3; ++k) {
    const V4 r = hn::Set(d, ray.inverse[k]);
    const V4 a = hn::Mul(row(rows + 16 * k, 0), r), b = hn::Mul(row(rows + 16 * k, 1), r),
             c = hn::Mul(row(rows + 16 * k, 2), r);
    entry = hn::Max(entry, hn::Add(hn::Min(a, hn::Min(b, c)), hn::Set(d, ray.gate_near_shift[k])));
    exit = hn::Min(exit, hn::Add(hn::Max(a, hn::Max(b, c)), hn::Set(d, ray.gate_far_shift[k])));
  }
  t = hn::Add(hn::Min(hn::Max(t, entry), exit), hn::Zero(d));
  hn::Store(t, d, ts);
  const auto in_range =
      hn::And(hn::Le(entry, exit), hn::And(hn::Ge(t, hn::Set(d, ray.t_min)), hn::Le(t, hn::Set(d, limit))));
  return lanes & mask_bits(d, in_range);
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
