// finish-inl.h: where on its triangle does each hit of a batch lie, and how does that triangle lie? Compiled
// once for each instruction set (kernels.cpp).
//
// u and v are worked out as in shape/triangle.h and the normal as Triangle::normal() does it, in double, with
// the same operations and so the same bits. Hits are collected lane by lane, with the axes in the order that
// the triangle test takes them; then everything runs on whole vectors.

#if defined(BOXWOOD_SIMD_FINISH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_FINISH_INL_H
#undef BOXWOOD_SIMD_FINISH_INL_H
#else
#define BOXWOOD_SIMD_FINISH_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <cstring>

#include "boxwood/simd/node-inl.h"
#include "boxwood/simd/triangle_tree.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

inline constexpr std::size_t kDoubles = kWidth == 4 ? 2 : HWY_TARGET <= HWY_AVX3 ? 8 : 4;
using DD = hn::FixedTag<double, kDoubles>;
using VD = hn::Vec<DD>;

/// The axis behind each.
inline constexpr std::uint8_t kNext[3] = {1, 2, 0};

/// Some hits, one for each lane.
struct HitLanes {
  static constexpr std::size_t kSize = 64;
  std::uint32_t count = 0;
  HWY_ALIGN float vertices[9][kSize];  // vertex, axis
  HWY_ALIGN float rays[6][kSize];      // origin, direction
  HWY_ALIGN double last_axis[kSize];   // which of x, y, z stands last
  HWY_ALIGN float u[kSize], v[kSize], sum[kSize];
  HWY_ALIGN float normal[3][kSize];
  std::uint32_t axes[kSize];
  std::uint32_t hit_index[kSize];

  /// Adds a hit. A miss is worked on like one, but does not count: who hits is hard to foresee.
  HWY_INLINE void add(const TriangleTree& tree, const Ray& ray, const TriangleHit& found,
                      std::uint32_t index) {
    const auto z = static_cast<std::size_t>(longest_axis(abs(ray.direction)));
    const std::size_t x = kNext[z], y = kNext[x];
    const std::uint32_t is_hit = found.is_hit();
    const auto* rows =
        reinterpret_cast<const float*>(&tree.block_at(found.block & (0u - is_hit))) + found.lane;
    for (std::size_t k = 0; k < 3; ++k) {
      vertices[3 * k][count] = rows[12 * k + 4 * x];
      vertices[3 * k + 1][count] = rows[12 * k + 4 * y];
      vertices[3 * k + 2][count] = rows[12 * k + 4 * z];
    }
    const float *origin = &ray.origin.x, *direction = &ray.direction.x;
    rays[0][count] = origin[x], rays[1][count] = origin[y], rays[2][count] = origin[z];
    rays[3][count] = direction[x], rays[4][count] = direction[y], rays[5][count] = direction[z];
    last_axis[count] = static_cast<double>(z);
    axes[count] = static_cast<std::uint32_t>(z);
    hit_index[count] = index;
    count += is_hit;
  }
};

/// The weights of the vertices, from the lane `i` on.
HWY_INLINE void weigh(HitLanes& lanes, std::size_t i) {
  const DW d;
  const auto ray = [&](int row) { return hn::Load(d, lanes.rays[row] + i); };
  const VW one = hn::Set(d, 1.0f);
  const VW sz = hn::Div(one, ray(5)), sx = hn::Mul(ray(3), sz), sy = hn::Mul(ray(4), sz);
  VW x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    const auto to = [&](int axis) {
      return hn::Sub(hn::Load(d, lanes.vertices[3 * k + axis] + i), ray(axis));
    };
    const VW z = to(2);
    x[k] = hn::Sub(to(0), hn::Mul(sx, z));
    y[k] = hn::Sub(to(1), hn::Mul(sy, z));
  }
  const auto edge = [&](int p, int q) { return hn::Sub(hn::Mul(x[p], y[q]), hn::Mul(y[p], x[q])); };
  const VW wa = edge(1, 2), wb = edge(2, 0), wc = edge(0, 1);
  const VW sum = hn::Add(hn::Add(wa, wb), wc), inverse_sum = hn::Div(one, sum);
  hn::Store(hn::Mul(wb, inverse_sum), d, lanes.u + i);
  hn::Store(hn::Mul(wc, inverse_sum), d, lanes.v + i);
  hn::Store(sum, d, lanes.sum + i);
}

/// The normals, with the axes still in the triangle test's order.
HWY_INLINE void find_normals(HitLanes& lanes, std::size_t i) {
  const DD d;
  const hn::Rebind<float, DD> df;
  const auto vertex = [&](int row) { return hn::PromoteTo(d, hn::Load(df, lanes.vertices[row] + i)); };
  VD e1[3], e2[3], n[3];
  for (int k = 0; k < 3; ++k) {
    const VD a = vertex(k);
    e1[k] = hn::Sub(vertex(3 + k), a);
    e2[k] = hn::Sub(vertex(6 + k), a);
  }
  for (int k = 0; k < 3; ++k) {
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    n[k] = hn::Sub(hn::Mul(e1[p], e2[q]), hn::Mul(e1[q], e2[p]));
  }

  // Squares are added x, y, z, and the sum of three depends on which comes last.
  const VD xx = hn::Mul(n[0], n[0]), yy = hn::Mul(n[1], n[1]), zz = hn::Mul(n[2], n[2]);
  const VD axis = hn::Load(d, lanes.last_axis + i);
  const auto is_x = hn::Eq(axis, hn::Zero(d)), is_y = hn::Eq(axis, hn::Set(d, 1.0));
  const VD first_two =
      hn::IfThenElse(is_x, hn::Add(zz, xx), hn::IfThenElse(is_y, hn::Add(yy, zz), hn::Add(xx, yy)));
  const VD last = hn::IfThenElse(is_x, yy, hn::IfThenElse(is_y, xx, zz));
  const VD size = hn::Sqrt(hn::Add(first_two, last));
  const VD scale = hn::IfThenElseZero(hn::Gt(size, hn::Zero(d)), hn::Div(hn::Set(d, 1.0), size));
  for (int k = 0; k < 3; ++k) hn::Store(hn::DemoteTo(df, hn::Mul(n[k], scale)), df, lanes.normal[k] + i);
}

/// Works out what was collected, and starts anew.
inline void finish_lanes(HitLanes& lanes, const TriangleTree& tree, std::span<const Ray> rays,
                         const TriangleHit* found, Hit* hits) {
  // Whole vectors: what is behind the last lane comes from an earlier turn and goes nowhere.
  for (std::size_t i = 0; i < lanes.count; i += kWidth) weigh(lanes, i);
  for (std::size_t i = 0; i < lanes.count; i += kDoubles) find_normals(lanes, i);

  for (std::size_t n = 0; n < lanes.count; ++n) {
    const std::uint32_t i = lanes.hit_index[n], z = lanes.axes[n];
    Hit& hit = hits[i];
    hit.t = found[i].t;
    hit.u = lanes.u[n];
    hit.v = lanes.v[n];
    float* normal = &hit.normal.x;
    normal[kNext[z]] = lanes.normal[0][n];
    normal[kNext[kNext[z]]] = lanes.normal[1][n];
    normal[z] = lanes.normal[2][n];

    // Weights that the scalar test would take through its exact branch go there.
    const float size = std::fabs(lanes.sum[n]);
    if (HWY_LIKELY(size > 0x1p-80f && size < 0x1p120f)) continue;
    const Triangle triangle = tree.block_at(found[i].block).triangle(found[i].lane);
    Crossing crossing;
    intersect_triangle(RayShear(rays[i].origin, rays[i].direction), triangle.a, triangle.b, triangle.c,
                       crossing);
    hit.u = crossing.u;
    hit.v = crossing.v;
  }
  lanes.count = 0;
}

inline void finish_all(const TriangleTree& tree, std::span<const Ray> rays, const TriangleHit* found,
                       Hit* hits) {
  constexpr std::size_t kAhead = 12;
  HitLanes lanes;
  std::memset(lanes.vertices, 0, sizeof lanes.vertices);
  std::memset(lanes.rays, 0, sizeof lanes.rays);
  std::memset(lanes.last_axis, 0, sizeof lanes.last_axis);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const TriangleHit& ahead = found[std::min(i + kAhead, rays.size() - 1)];
    const char* block = reinterpret_cast<const char*>(&tree.block_at(ahead.block & (0u - ahead.is_hit())));
    for (int line = 0; line < 3; ++line) __builtin_prefetch(block + 64 * line);
    hits[i] = Hit{};
    lanes.add(tree, rays[i], found[i], static_cast<std::uint32_t>(i));
    if (lanes.count == HitLanes::kSize) finish_lanes(lanes, tree, rays, found, hits);
  }
  finish_lanes(lanes, tree, rays, found, hits);
}

/// Works out one hit, whose ray is still at hand.
HWY_INLINE void finish_one(const TriangleTree& tree, const KernelRay& ray, const TriangleHit& found,
                           Hit& hit) {
  const TriangleBlock& block = tree.block_at(found.block);
  const char* lane = reinterpret_cast<const char*>(&block) + 4 * found.lane;
  const auto from_origin = [&](int vertex, int k) {
    return ray.origin[k] - *reinterpret_cast<const float*>(lane + 48 * vertex + ray.axis_row[k]);
  };
  const float sx = ray.shear[0], sy = ray.shear[1];
  const float az = from_origin(0, 2), bz = from_origin(1, 2), cz = from_origin(2, 2);
  const float ax = from_origin(0, 0) - sx * az, ay = from_origin(0, 1) - sy * az;
  const float bx = from_origin(1, 0) - sx * bz, by = from_origin(1, 1) - sy * bz;
  const float cx = from_origin(2, 0) - sx * cz, cy = from_origin(2, 1) - sy * cz;
  const float wa = bx * cy - by * cx, wb = cx * ay - cy * ax, wc = ax * by - ay * bx;
  const float sum = wa + wb + wc, inverse_sum = 1.0f / sum;
  const Triangle triangle = block.triangle(found.lane);
  hit.t = found.t;
  hit.u = wb * inverse_sum;
  hit.v = wc * inverse_sum;
  hit.normal = triangle.normal();
  if (HWY_LIKELY(std::fabs(sum) > 0x1p-80f && std::fabs(sum) < 0x1p120f)) return;
  Crossing crossing;
  intersect_triangle(ray.shear_constants(), triangle.a, triangle.b, triangle.c, crossing);
  hit.u = crossing.u;
  hit.v = crossing.v;
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
