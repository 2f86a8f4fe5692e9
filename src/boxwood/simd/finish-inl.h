// finish-inl.h: where on its triangle does each hit of a batch lie, and how does that triangle lie? Compiled
// once for each instruction set (kernels.cpp).
//
// u and v are worked out as in shape/triangle.h and the normal as Triangle::normal() does it, in double, with
// the same operations and so the same bits. Hits are listed, and then fetched and worked out a whole vector
// at a time.

#if defined(BOXWOOD_SIMD_FINISH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_FINISH_INL_H
#undef BOXWOOD_SIMD_FINISH_INL_H
#else
#define BOXWOOD_SIMD_FINISH_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "boxwood/simd/single-inl.h"
#include "boxwood/simd/triangle_tree.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

/// As many hits as one vector has lanes.
inline constexpr std::size_t kFinished = HWY_MAX_BYTES / 4 < 16 ? HWY_MAX_BYTES / 4 : 16;
using DF = hn::FixedTag<float, kFinished>;
using DIF = hn::FixedTag<std::int32_t, kFinished>;
using VF = hn::Vec<DF>;
using VIF = hn::Vec<DIF>;

/// Calls finish(numbers, count) with the rays that hit, kFinished at a time; of the last only `count` are
/// wanted. block_of(i, mask) says where the block lies that ray i hit, and is safe to ask of a miss, with a
/// mask of 0.
template <class IsHit, class BlockOf, class Finish>
HWY_INLINE void finish_listed(std::size_t ray_count, const IsHit& is_hit, const BlockOf& block_of,
                              const Finish& finish) {
  constexpr std::size_t kSize = 64;
  HWY_ALIGN std::uint32_t list[kSize + kFinished];
  std::size_t count = 0;
  const auto finish_list = [&] {
    // Whole vectors: what is missing in the last one is its last hit once more.
    if (count % kFinished != 0) std::fill_n(list + count, kFinished - count % kFinished, list[count - 1]);
    for (std::size_t n = 0; n < count; n += kFinished) finish(list + n, std::min(kFinished, count - n));
    count = 0;
  };
  for (std::size_t i = 0; i < ray_count; ++i) {
    // Without a branch: who hits is hard to foresee.
    const std::uint32_t hits = is_hit(i);
    const char* block = block_of(i, 0u - hits);
    for (int line = 0; line < 3; ++line) __builtin_prefetch(block + 64 * line);
    list[count] = static_cast<std::uint32_t>(i);
    count += hits;
    if (count == kSize) finish_list();
  }
  finish_list();
}

/// What the scalar test says of a triangle that is hit.
inline Crossing cross(const RayShear& shear, const Triangle& triangle) {
  Crossing crossing;
  intersect_triangle(shear, triangle.a, triangle.b, triangle.c, crossing);
  return crossing;
}

/// Whether weights with this sum are as the scalar test has them; where it would take its exact branch, ask
/// it.
inline bool is_plain(float sum) {
  const float size = std::fabs(sum);
  return size > 0x1p-80f && size < 0x1p120f;
}

/// Three coordinates of each lane in the order of the triangle test, when the longest axis is y or z.
HWY_INLINE void turn_axes(VF (&v)[3], hn::Mask<DF> is_y, hn::Mask<DF> is_z) {
  const VF x = v[0], y = v[1], z = v[2];
  v[0] = hn::IfThenElse(is_z, x, hn::IfThenElse(is_y, z, y));
  v[1] = hn::IfThenElse(is_z, y, hn::IfThenElse(is_y, x, z));
  v[2] = hn::IfThenElse(is_z, z, hn::IfThenElse(is_y, y, x));
}

/// The weights of the vertices `v`; the sum of what they were before they were scaled to 1.
struct Weights {
  VF u, v, sum;
};
HWY_INLINE Weights weigh(VF (&v)[3][3], VF (&origin)[3], VF (&direction)[3]) {
  const DF d;
  const VF abs_x = hn::Abs(direction[0]), abs_y = hn::Abs(direction[1]), abs_z = hn::Abs(direction[2]);
  const auto is_z = hn::And(hn::Gt(abs_z, abs_x), hn::Gt(abs_z, abs_y));
  const auto is_y = hn::AndNot(is_z, hn::Gt(abs_y, abs_x));
  turn_axes(origin, is_y, is_z);
  turn_axes(direction, is_y, is_z);

  const VF sz = hn::Div(hn::Set(d, 1.0f), direction[2]);
  const VF sx = hn::Mul(direction[0], sz), sy = hn::Mul(direction[1], sz);
  VF x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    turn_axes(v[k], is_y, is_z);
    const VF z = hn::Sub(v[k][2], origin[2]);
    x[k] = hn::Sub(hn::Sub(v[k][0], origin[0]), hn::Mul(sx, z));
    y[k] = hn::Sub(hn::Sub(v[k][1], origin[1]), hn::Mul(sy, z));
  }
  const auto edge = [&](int p, int q) { return hn::Sub(hn::Mul(x[p], y[q]), hn::Mul(y[p], x[q])); };
  const VF wa = edge(1, 2), wb = edge(2, 0), wc = edge(0, 1);
  const VF sum = hn::Add(hn::Add(wa, wb), wc), inverse_sum = hn::Div(hn::Set(d, 1.0f), sum);
  const VF zero = hn::Zero(d);
  return {hn::Add(hn::Mul(wb, inverse_sum), zero), hn::Add(hn::Mul(wc, inverse_sum), zero), sum};
}

/// The normals of the triangles with the vertices `v`.
#if HWY_HAVE_FLOAT64
HWY_INLINE void find_normals(const VF (&v)[3][3], VF (&normal)[3]) {
  const hn::FixedTag<double, kFinished / 2> d;
  const hn::FixedTag<float, kFinished / 2> half;
  using VD = hn::Vec<decltype(d)>;
  const auto of = [&](const auto& vertex, auto(&n)[3]) {
    VD e1[3], e2[3], c[3];
    for (int k = 0; k < 3; ++k) {
      const VD a = vertex(0, k);
      e1[k] = hn::Sub(vertex(1, k), a);
      e2[k] = hn::Sub(vertex(2, k), a);
    }
    for (int k = 0; k < 3; ++k) {
      const int p = (k + 1) % 3, q = (k + 2) % 3;
      c[k] = hn::Sub(hn::Mul(e1[p], e2[q]), hn::Mul(e1[q], e2[p]));
    }
    const VD size2 = hn::Add(hn::Add(hn::Mul(c[0], c[0]), hn::Mul(c[1], c[1])), hn::Mul(c[2], c[2]));
    const VD size = hn::Sqrt(size2);
    const VD scale = hn::IfThenElseZero(hn::Gt(size, hn::Zero(d)), hn::Div(hn::Set(d, 1.0), size));
    for (int k = 0; k < 3; ++k) n[k] = hn::DemoteTo(half, hn::Mul(c[k], scale));
  };
  hn::Vec<decltype(half)> lower[3], upper[3];
  of([&](int i, int k) { return hn::PromoteTo(d, hn::LowerHalf(half, v[i][k])); }, lower);
  of([&](int i, int k) { return hn::PromoteTo(d, hn::UpperHalf(half, v[i][k])); }, upper);
  for (int k = 0; k < 3; ++k) normal[k] = hn::Combine(DF(), upper[k], lower[k]);
}
#else  // Highway has no vectors of doubles here: one by one.
HWY_INLINE void find_normals(const VF (&v)[3][3], VF (&normal)[3]) {
  HWY_ALIGN float at[3][3][kFinished], found[3][kFinished];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) hn::Store(v[i][k], DF(), at[i][k]);
  for (std::size_t n = 0; n < kFinished; ++n) {
    const auto vertex = [&](int i) { return Vec3{at[i][0][n], at[i][1][n], at[i][2][n]}; };
    const Vec3 unit = Triangle{vertex(0), vertex(1), vertex(2)}.normal();
    for (int k = 0; k < 3; ++k) found[k][n] = unit[k];
  }
  for (int k = 0; k < 3; ++k) normal[k] = hn::Load(DF(), found[k]);
}
#endif

/// Writes `count` of the hits that have been worked out; asks cross_exactly(i) for weights that need it.
template <class Found, class Cross>
HWY_INLINE void write_group(const Weights& weights, const VF (&normal)[3], const Found* found,
                            const std::uint32_t* ray_index, std::size_t count, Hit* hits,
                            const Cross& cross_exactly) {
  const DF d;
  HWY_ALIGN float us[kFinished], vs[kFinished], sums[kFinished], normals[3][kFinished];
  hn::Store(weights.u, d, us);
  hn::Store(weights.v, d, vs);
  hn::Store(weights.sum, d, sums);
  for (int k = 0; k < 3; ++k) hn::Store(normal[k], d, normals[k]);
  for (std::size_t n = 0; n < count; ++n) {
    const std::uint32_t i = ray_index[n];
    Hit& hit = hits[i];
    hit.t = found[i].t;
    hit.u = us[n];
    hit.v = vs[n];
    hit.normal = {normals[0][n], normals[1][n], normals[2][n]};
    if (HWY_LIKELY(is_plain(sums[n]))) continue;
    const Crossing crossing = cross_exactly(i);
    hit.u = crossing.u;
    hit.v = crossing.v;
  }
}

/// Fetches the vertices of kFinished hits, found[ray_index[i]].
template <class Layout>
struct VertexFetch;

template <>
struct VertexFetch<FullLayout> {
  static HWY_INLINE void run(const TriangleTree& tree, const TriangleHit* found,
                             const std::uint32_t* ray_index, VF (&v)[3][3]) {
    // Offsets count floats, from the middle of what 32 bits reach.
    const DF d;
    const DIF di;
    const VIF at = hn::ShiftLeft<2>(hn::Load(di, reinterpret_cast<const std::int32_t*>(ray_index)));
    const auto* words = reinterpret_cast<const std::int32_t*>(found);
    const VIF block = hn::GatherIndex(di, words + 2, at), lane = hn::GatherIndex(di, words + 3, at);
    const VIF vertex_at = hn::Add(
        hn::Xor(hn::ShiftLeft<3>(block), hn::Set(di, std::numeric_limits<std::int32_t>::min())), lane);
    const std::uintptr_t middle =
        reinterpret_cast<std::uintptr_t>(tree.pool()) + static_cast<std::uintptr_t>(std::uint64_t(1) << 33);
    for (unsigned i = 0; i < 3; ++i)
      for (unsigned k = 0; k < 3; ++k)
        v[i][k] = hn::GatherIndex(d, reinterpret_cast<const float*>(middle + 48 * i + 16 * k), vertex_at);
  }
};

template <>
struct VertexFetch<CompactLayout> {
  static HWY_INLINE void run(const TriangleTree& tree, const TriangleHit* found,
                             const std::uint32_t* ray_index, VF (&v)[3][3]) {
    HWY_ALIGN float vertices[3][3][kFinished];
    for (std::size_t n = 0; n < kFinished; ++n) {
      const TriangleHit& hit = found[ray_index[n]];
      const Triangle triangle = tree.triangle(hit.block, hit.lane);
      for (int k = 0; k < 3; ++k) {
        vertices[0][k][n] = triangle.a[k];
        vertices[1][k][n] = triangle.b[k];
        vertices[2][k][n] = triangle.c[k];
      }
    }
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) v[i][k] = hn::Load(DF(), vertices[i][k]);
  }
};

/// Works out kFinished hits, of which `count` are wanted.
template <class Layout>
HWY_INLINE void finish_group(const TriangleTree& tree, const Ray* rays, const TriangleHit* found,
                             const std::uint32_t* ray_index, std::size_t count, Hit* hits) {
  const DF d;
  const DIF di;
  const VIF index = hn::Load(di, reinterpret_cast<const std::int32_t*>(ray_index));

  VF origin[3], direction[3], v[3][3], normal[3];
  const VIF ray_at = hn::ShiftLeft<3>(index);
  for (int k = 0; k < 3; ++k) {
    origin[k] = hn::GatherIndex(d, &rays->origin.x + k, ray_at);
    direction[k] = hn::GatherIndex(d, &rays->direction.x + k, ray_at);
  }
  VertexFetch<Layout>::run(tree, found, ray_index, v);

  find_normals(v, normal);
  const Weights weights = weigh(v, origin, direction);

  write_group(weights, normal, found, ray_index, count, hits, [&](std::uint32_t i) {
    return cross(RayShear(rays[i].origin, rays[i].direction), tree.triangle(found[i].block, found[i].lane));
  });
}

template <class Layout>
void finish_all(const TriangleTree& tree, std::span<const Ray> rays, const TriangleHit* found, Hit* hits) {
  std::fill_n(hits, rays.size(), Hit{});
  finish_listed(
      rays.size(), [&](std::size_t i) { return found[i].is_hit(); },
      [&](std::size_t i, std::uint32_t mask) {
        return tree.pool() + std::size_t(found[i].block & mask) * TriangleTree::kUnit;
      },
      [&](const std::uint32_t* ray_index, std::size_t count) {
        finish_group<Layout>(tree, rays.data(), found, ray_index, count, hits);
      });
}

/// The first three lanes, each from a vector of its own.
HWY_INLINE V4 first_of_each(V4 a, V4 b, V4 c) {
  return hn::ConcatUpperLower(D4(), c, hn::OddEven(b, a));
}
/// The lanes y, z, x of (x, y, z, anything).
HWY_INLINE V4 turned(V4 v) {
  return hn::TableLookupLanes(v, hn::SetTableIndices(D4(), kAxes[0]));
}

/// The normal of the triangle in the lane of a block that `lane` points to.
#if HWY_HAVE_FLOAT64 && HWY_MAX_BYTES >= 32
HWY_INLINE Vec3 normal_of(const TriangleBlock&, const char* lane, std::uint32_t) {
  const D4 d;
  const hn::FixedTag<double, 4> dd;
  const auto vertex = [&](int i, auto& xyz, auto& yzx) {
    V4 v[3];
    for (int k = 0; k < 3; ++k) v[k] = hn::Set(d, *reinterpret_cast<const float*>(lane + 48 * i + 16 * k));
    xyz = hn::PromoteTo(dd, first_of_each(v[0], v[1], v[2]));
    yzx = hn::PromoteTo(dd, first_of_each(v[1], v[2], v[0]));
  };
  hn::Vec<decltype(dd)> a, b, c, turned_a, turned_b, turned_c;
  vertex(0, a, turned_a);
  vertex(1, b, turned_b);
  vertex(2, c, turned_c);

  // The cross product's z, x and y.
  const auto n = hn::Sub(hn::Mul(hn::Sub(b, a), hn::Sub(turned_c, turned_a)),
                         hn::Mul(hn::Sub(turned_b, turned_a), hn::Sub(c, a)));
  const hn::Half<decltype(dd)> half;
  const auto squares = hn::Mul(n, n);
  const auto zx = hn::LowerHalf(half, squares), y = hn::UpperHalf(half, squares);
  const double size = std::sqrt(hn::GetLane(hn::Add(hn::Add(hn::Shuffle01(zx), y), zx)));
  const double scale = size > 0 ? 1 / size : 0;
  HWY_ALIGN float xyz[4];
  hn::Store(turned(hn::DemoteTo(d, hn::Mul(n, hn::Set(dd, scale)))), d, xyz);
  return {xyz[0], xyz[1], xyz[2]};
}
#else
HWY_INLINE Vec3 normal_of(const TriangleBlock& block, const char*, std::uint32_t lane) {
  return block.triangle(lane).normal();
}
#endif

/// Works out one hit, whose ray and edge functions are still at hand.
template <class Layout>
HWY_INLINE void finish_one(const TriangleTree& tree, const KernelRay& ray, const TriangleHit& found,
                           const EdgesOfHit& edges, Hit& hit) {
  const TriangleBlock& block = Layout::block(tree.pool() + std::size_t(found.block) * TriangleTree::kUnit);
  const char* lane = reinterpret_cast<const char*>(&block) + 4 * found.lane;

  const float wa = edges.wa[found.lane], wb = edges.wb[found.lane], wc = edges.wc[found.lane];
  const float sum = wa + wb + wc, inverse_sum = 1.0f / sum;
  hit.t = found.t;
  hit.u = wb * inverse_sum + 0.0f;
  hit.v = wc * inverse_sum + 0.0f;
  hit.normal = normal_of(block, lane, found.lane);
  if (HWY_LIKELY(is_plain(sum))) return;
  const Crossing crossing = cross(ray.shear_constants(), block.triangle(found.lane));
  hit.u = crossing.u;
  hit.v = crossing.v;
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
