// closest_point-inl.h: which point of a tree's triangles is nearest? Compiled once for each instruction set
// (kernels.cpp).
//
// The walk of single-inl.h with squared distances in place of t: all children of a node at once, the nearest
// first. Distances to boxes are worked out in float and only have to be conservative; the limit that they are
// held against is widened by more than they can be off. Triangles are worked out in double, four at once: the
// operations of Triangle::closest_point (shape/triangle.cpp) and of query/distance.h in the same order, and
// so the same bits. All four candidates of a triangle are compared, without a branch
// (docs/algorithms/closest-point.md says why not by regions).

#if defined(BOXWOOD_SIMD_CLOSEST_POINT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_CLOSEST_POINT_INL_H
#undef BOXWOOD_SIMD_CLOSEST_POINT_INL_H
#else
#define BOXWOOD_SIMD_CLOSEST_POINT_INL_H
#endif

#include <cmath>

#include "boxwood/simd/single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

/// A square of a box distance is off by less than 2^-20 of itself; below kLeastSquare floats are no longer
/// that exact.
inline constexpr float kDistanceSlack = 0x1p-18f, kLeastSquare = 0x1p-100f;

/// Nothing within `distance` is in a box whose square is larger than this; that of an empty box is.
inline float squared_reach(float distance, float part_slack) {
  const float reach = distance * (1 + kDistanceSlack) + part_slack;
  return min(reach * reach * (1 + kDistanceSlack) + kLeastSquare, std::numeric_limits<float>::max());
}

/// How far the nearest point of a triangle may be outside of the part that it belongs to, after rounding.
inline float slack_of_parts(const TriangleTree& tree) {
  if (!tree.has_parts()) return 0;
  return max_component(max(abs(tree.box().lower), abs(tree.box().upper))) * 0x1p-20f;
}

/// The nearest points of the triangles of a block, as far as they may matter.
struct BlockPoints {
  std::uint32_t lanes = 0;  ///< Those within the limit, as bits.
  HWY_ALIGN float distance[kBlockWidth];
  HWY_ALIGN float position[3][kBlockWidth];
};

#if HWY_HAVE_FLOAT64
/// As many triangles at once as one vector of doubles takes, four at most.
inline constexpr std::size_t kDoubles = HWY_MAX_BYTES >= 32 ? 4 : 2;
using DD = hn::FixedTag<double, kDoubles>;
using DH = hn::FixedTag<float, kDoubles>;
using VD = hn::Vec<DD>;

/// A point for each lane.
struct Points {
  VD x, y, z;
};
HWY_INLINE Points sum(const Points& a, const Points& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Points difference(const Points& a, const Points& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Points product(const Points& a, VD s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
HWY_INLINE VD dot_of(const Points& a, const Points& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Points cross_of(const Points& a, const Points& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE Points choose(hn::Mask<DD> which, const Points& yes, const Points& no) {
  return {hn::IfThenElse(which, yes.x, no.x), hn::IfThenElse(which, yes.y, no.y),
          hn::IfThenElse(which, yes.z, no.z)};
}

/// closest_on_segment of shape/vec3d.h; `to_p` is p - a.
HWY_INLINE Points on_segment(const Points& a, const Points& b, const Points& to_p) {
  const Points along = difference(b, a);
  const VD size2 = dot_of(along, along), s = dot_of(to_p, along);
  const Points between = sum(a, product(along, hn::Div(s, size2)));
  return choose(hn::Gt(s, hn::Zero(DD())), choose(hn::Ge(s, size2), b, between), a);
}

/// Takes the nearer of two points, the first when they are as near.
HWY_INLINE void consider(const Points& candidate, const Points& p, Points& best, VD& least) {
  const Points to = difference(candidate, p);
  const VD d2 = dot_of(to, to);
  const auto is_nearer = hn::Lt(d2, least);
  least = hn::IfThenElse(is_nearer, d2, least);
  best = choose(is_nearer, candidate, best);
}

/// Triangle::closest_point.
HWY_INLINE Points nearest_on_triangles(const Points& p, const Points& a, const Points& b, const Points& c) {
  const DD d;
  const Points ap = difference(p, a);
  Points best = a;
  VD least = hn::Set(d, std::numeric_limits<double>::infinity());
  consider(on_segment(a, b, ap), p, best, least);
  consider(on_segment(b, c, difference(p, b)), p, best, least);
  consider(on_segment(c, a, difference(p, c)), p, best, least);

  const Points ab = difference(b, a), ac = difference(c, a);
  const Points n = cross_of(ab, ac);
  const VD n2 = dot_of(n, n), v = dot_of(cross_of(ab, ap), n), u = dot_of(cross_of(ap, ac), n);
  const Points foot = sum(sum(a, product(ab, hn::Div(u, n2))), product(ac, hn::Div(v, n2)));
  const VD zero = hn::Zero(d);
  const auto is_inside = hn::And(hn::And(hn::Gt(n2, zero), hn::Gt(u, zero)),
                                 hn::And(hn::Gt(v, zero), hn::Lt(hn::Add(u, v), n2)));
  const Points to = difference(foot, p);
  return choose(hn::And(is_inside, hn::Lt(dot_of(to, to), least)), foot, best);
}

/// The points of a block's triangles within `limit` of `point`.
HWY_INLINE void find_points(const TriangleBlock& block, Vec3 point, float limit, BlockPoints& found) {
  const DD d;
  const DH half;
  const Points p{hn::Set(d, point.x), hn::Set(d, point.y), hn::Set(d, point.z)};
  // Above every square whose root rounds to the limit.
  const VD limit2 = hn::Set(d, double(limit) * double(limit) * (1 + 0x1p-20) + 0x1p-270);
  found.lanes = 0;
  for (std::size_t first = 0; first < kBlockWidth; first += kDoubles) {
    // The triangles' own boxes: no triangle is nearer.
    VD x[3], y[3], z[3];  // of the three corners
    const auto load = [&](int k, VD at, VD(&corner)[3]) {
      hn::Vec<DH> v[3];
      for (int i = 0; i < 3; ++i) {
        v[i] = hn::Load(half, block.v[i][k] + first);
        corner[i] = hn::PromoteTo(d, v[i]);
      }
      const VD lower = hn::PromoteTo(d, hn::Min(v[0], hn::Min(v[1], v[2])));
      const VD upper = hn::PromoteTo(d, hn::Max(v[0], hn::Max(v[1], v[2])));
      const VD outside = hn::Max(hn::Max(hn::Sub(lower, at), hn::Sub(at, upper)), hn::Zero(d));
      return hn::Mul(outside, outside);
    };
    const VD square_x = load(0, p.x, x), square_y = load(1, p.y, y), square_z = load(2, p.z, z);
    const VD box2 = hn::Add(hn::Add(square_x, square_y), square_z);
    if (hn::AllFalse(d, hn::Le(box2, limit2))) continue;

    // The distance is that of the point as it is returned, in float.
    const Points exact = nearest_on_triangles(p, {x[0], y[0], z[0]}, {x[1], y[1], z[1]}, {x[2], y[2], z[2]});
    const hn::Vec<DH> near_x = hn::DemoteTo(half, exact.x), near_y = hn::DemoteTo(half, exact.y),
                      near_z = hn::DemoteTo(half, exact.z);
    const Points to =
        difference({hn::PromoteTo(d, near_x), hn::PromoteTo(d, near_y), hn::PromoteTo(d, near_z)}, p);
    const VD square = hn::Max(dot_of(to, to), box2);
    const std::uint32_t maybe = mask_bits(d, hn::Le(square, limit2));
    if (maybe == 0) continue;
    const hn::Vec<DH> distance = hn::DemoteTo(half, hn::Sqrt(square));
    hn::Store(distance, half, found.distance + first);
    hn::Store(near_x, half, found.position[0] + first);
    hn::Store(near_y, half, found.position[1] + first);
    hn::Store(near_z, half, found.position[2] + first);
    found.lanes |= (maybe & mask_bits(half, hn::Le(distance, hn::Set(half, limit)))) << first;
  }
}
#else  // Highway has no vectors of doubles here: one by one.
HWY_INLINE void find_points(const TriangleBlock& block, Vec3 point, float limit, BlockPoints& found) {
  found.lanes = 0;
  for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
    const Triangle triangle = block.triangle(lane);
    const Box3 box = triangle.box();
    const Vec3 position = triangle.closest_point(point);
    double square = 0, box2 = 0;
    for (int k = 0; k < 3; ++k) {
      const double to = double(position[k]) - point[k];
      const double outside =
          std::max({double(box.lower[k]) - point[k], double(point[k]) - box.upper[k], 0.0});
      square += to * to;
      box2 += outside * outside;
      found.position[k][lane] = position[k];
    }
    found.distance[lane] = static_cast<float>(std::sqrt(std::max(square, box2)));
    found.lanes |= static_cast<std::uint32_t>(found.distance[lane] <= limit) << lane;
  }
}
#endif

/// Keeps the nearest in the order of the contract; a filling lane has the key of the first, and loses.
/// Returns whether `nearest` changed; its distance is the limit.
HWY_INLINE bool take_nearest(const TriangleBlock& block, std::uint32_t at, Vec3 point,
                             TrianglePoint& nearest) {
  BlockPoints found;
  find_points(block, point, nearest.distance, found);
  bool changed = false;
  for (std::uint32_t lanes = found.lanes; lanes; lanes &= lanes - 1) {
    const auto lane = static_cast<std::uint32_t>(__builtin_ctz(lanes));
    const float distance = found.distance[lane];
    if (distance > nearest.distance || (distance == nearest.distance && block.key[lane] >= nearest.key))
      continue;
    nearest = {distance,
               {found.position[0][lane], found.position[1][lane], found.position[2][lane]},
               block.key[lane],
               at};
    changed = true;
  }
  return changed;
}

/// nearest.distance is the limit before; nearest.block a block to look at first, or none.
template <class Layout>
HWY_NOINLINE void closest_point_one(const TriangleTree& tree, Vec3 point, TrianglePoint& nearest) {
  const DW d;
  const DIW di;
  const char* pool = tree.pool();
  const float part_slack = slack_of_parts(tree);
  const VW p[3] = {hn::Set(d, point.x), hn::Set(d, point.y), hn::Set(d, point.z)};
  TrianglePoint best{nearest.distance, {}, TrianglePoint::kNone, TrianglePoint::kNone};
  if (nearest.block != TrianglePoint::kNone)
    take_nearest(Layout::block(pool + std::size_t(nearest.block) * TriangleTree::kUnit), nearest.block, point,
                 best);
  float limit2 = squared_reach(best.distance, part_slack);

  HWY_ALIGN std::int32_t keys[kStackSize], refs[kStackSize];
  keys[0] = std::numeric_limits<std::int32_t>::min();  // below every limit
  refs[0] = static_cast<std::int32_t>(kBottom);
  std::size_t top = 0;
  std::uint32_t current = 0;
  while (true) {
    if ((current & 3) == 0) {
      // The squares of the distances to the children.
      const char* node = node_at(pool, current);
      const typename Layout::Planes planes(node);
      VW square = hn::Zero(d);
      for (int k = 0; k < 3; ++k) {
        const VW lower = planes.row(k, 2 * k * kRowBytes), upper = planes.row(k, (2 * k + 1) * kRowBytes);
        const VW outside = hn::Max(hn::Max(hn::Sub(lower, p[k]), hn::Sub(p[k], upper)), hn::Zero(d));
        square = hn::MulAdd(outside, outside, square);
      }
      const auto may_matter = hn::RebindMask(di, hn::Le(square, hn::Set(d, limit2)));
      const std::int32_t* children = children_of<Layout>(node);
      const std::uint32_t bits = mask_bits(di, may_matter);
      if (bits != 0) {
        // On to the nearest; the others wait, the farthest at the bottom.
        const auto count = static_cast<std::size_t>(__builtin_popcount(bits));
        if (count == 1) {
          current = static_cast<std::uint32_t>(children[__builtin_ctz(bits)]);
          continue;
        }
        push_children(di, make_keys(hn::BitCast(di, square)), may_matter, children, count, keys + top + 1,
                      refs + top + 1);
        top += count - 1;
        current = static_cast<std::uint32_t>(refs[top + 1]);
        prefetch_lines<Layout::kNodeLines>(node_at(pool, static_cast<std::uint32_t>(refs[top])));
        continue;
      }
    } else {
      if (current == kBottom) break;
      const char* block = blocks_at(pool, current);
      bool changed = false;
      for (std::uint32_t left = current >> 2 & 3; left > 0; --left, block += Layout::kBlockBytes)
        changed |= take_nearest(Layout::block(block), units(pool, block), point, best);
      if (changed) limit2 = squared_reach(best.distance, part_slack);
    }
    const std::int32_t limit_key = std::bit_cast<std::int32_t>(limit2) | kChildBits;
    while (keys[top] > limit_key) --top;
    current = static_cast<std::uint32_t>(refs[top]);
    --top;
  }
  nearest = best;
}

/// Whether no float of the walk can overflow.
HWY_INLINE bool is_ordinary_point(Vec3 point) {
  const Vec3 size = abs(point);
  return size.x <= kLargestReach && size.y <= kLargestReach && size.z <= kLargestReach;
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
