// bundle_rays-inl.h: what do we know of rays that go the same way, and which of them meet a box, or a
// triangle? Compiled once for each instruction set.
//
// A lane for each ray. The operations of a lane are those of prepare(), test_edges() and test_planes(), in
// the same order: the same bits.

#if defined(BOXWOOD_SIMD_BUNDLE_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_BUNDLE_RAYS_INL_H
#undef BOXWOOD_SIMD_BUNDLE_RAYS_INL_H
#else
#define BOXWOOD_SIMD_BUNDLE_RAYS_INL_H
#endif

#include "boxwood/simd/single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

inline constexpr int kBundle = HWY_MAX_BYTES / 4 < 16 ? HWY_MAX_BYTES / 4 : 16;  // rays

using DB = hn::FixedTag<float, kBundle>;
using DIB = hn::FixedTag<std::int32_t, kBundle>;
using VB = hn::Vec<DB>;
using VIB = hn::Vec<DIB>;
using MB = hn::Mask<DB>;

/// The smallest and the largest lane.
struct Range {
  float low, high;
  HWY_INLINE explicit Range(VB v)
      : low(hn::GetLane(hn::MinOfLanes(DB(), v))), high(hn::GetLane(hn::MaxOfLanes(DB(), v))) {}
};

/// Rays with one longest axis, and one direction along each axis, and what they have hit.
template <bool kAny>
class BundleRays {
 public:
  /// Written out: gcc compiles an implicit one for the plain machine, where vectors cannot be made.
  HWY_INLINE BundleRays() {}

  /// Takes kBundle rays; false when they do not go the same way, or are not all ordinary.
  HWY_INLINE bool prepare(const Ray* rays, const Box3& bounds, float box_slack) {
    const DB d;
    VB dir[3], t_min, t_max;
    load(rays, origin_, t_min, dir, t_max);

    // As in prepare() for one ray (ray-inl.h), a lane for each ray.
    VB abs_dir[3], reach = hn::Zero(d);
    auto ordinary = hn::Eq(reach, reach);
    for (int k = 0; k < 3; ++k) {
      abs_dir[k] = hn::Abs(dir[k]);
      const VB to_corner = hn::Max(hn::Abs(hn::Sub(hn::Set(d, bounds.lower[k]), origin_[k])),
                                   hn::Abs(hn::Sub(hn::Set(d, bounds.upper[k]), origin_[k])));
      ordinary = hn::And(ordinary, hn::Le(hn::Add(abs_dir[k], to_corner), hn::Set(d, kLargestReach)));
      reach = hn::Max(reach, to_corner);
    }
    const VB d_max = hn::Max(abs_dir[0], hn::Max(abs_dir[1], abs_dir[2]));
    t_min_ = hn::Add(hn::IfThenElse(hn::Lt(t_min, hn::Zero(d)), hn::Zero(d), t_min), hn::Zero(d));
    ordinary =
        hn::And(ordinary, hn::And(hn::Ge(d_max, hn::Set(d, kSmallestDirection)), hn::Ge(t_max, t_min_)));
    if (!hn::AllTrue(d, ordinary)) return false;

    // One longest axis, and one direction along each axis, for all.
    const auto beyond_xy = hn::And(hn::Gt(abs_dir[2], abs_dir[0]), hn::Gt(abs_dir[2], abs_dir[1]));
    const auto is_y = hn::Gt(abs_dir[1], abs_dir[0]);
    const int z = hn::AllTrue(d, beyond_xy)     ? 2
                  : !hn::AllFalse(d, beyond_xy) ? -1
                  : hn::AllTrue(d, is_y)        ? 1
                  : !hn::AllFalse(d, is_y)      ? -1
                                                : 0;
    if (z < 0) return false;
    for (int k = 0; k < 3; ++k) {
      const auto backward = hn::Lt(hn::BitCast(DIB(), dir[k]), hn::Zero(DIB()));
      const bool is_backward = hn::AllTrue(DIB(), backward);
      if (!is_backward && !hn::AllFalse(DIB(), backward)) return false;
      near_row_[k] = kRowBytes * (2 * k + is_backward);
      far_row_[k] = near_row_[k] ^ kRowBytes;
      axis_[k] = kAxes[z][k];
    }

    // Whether they stay together: one after the other in a picture, not scattered by a surface.
    const auto is_near_first = [&](VB v, VB distance) {
      const VB first = hn::Set(d, hn::GetLane(v));
      return hn::Le(hn::Abs(hn::Sub(v, first)), distance);
    };
    const VB scale = hn::Div(hn::Set(d, 1.0f), dir[z]);
    const VB turn = hn::Set(d, 0.05f), step = hn::Mul(reach, hn::Set(d, 0x1p-9f));
    shear_[2] = scale;
    shear_[0] = hn::Mul(dir[axis_[0]], scale);
    shear_[1] = hn::Mul(dir[axis_[1]], scale);
    auto together = hn::And(is_near_first(shear_[0], turn), is_near_first(shear_[1], turn));
    for (int k = 0; k < 3; ++k) together = hn::And(together, is_near_first(origin_[k], step));
    if (!hn::AllTrue(d, together)) return false;

    // The slabs.
    constexpr float u = 0x1p-24f;
    const VB least = hn::Mul(d_max, hn::Set(d, 0x1p-30f)), tiny = hn::Set(d, 0x1p-140f);
    for (int k = 0; k < 3; ++k) {
      const VB r = hn::Div(hn::Set(d, 1.0f), hn::CopySign(hn::Max(abs_dir[k], least), dir[k]));
      const VB error =
          hn::Add(hn::Mul(hn::Set(d, 12 * u), reach), hn::Mul(hn::Set(d, 8 * u), hn::Abs(origin_[k])));
      const VB slack = hn::Add(hn::Mul(hn::Abs(r), hn::Add(error, tiny)), tiny);
      const VB wide_slack = hn::Add(hn::Mul(slack, hn::Set(d, box_slack)), hn::Set(d, 0x1p-120f));
      const VB shift = hn::Neg(hn::Mul(origin_[k], r));
      inverse_[k] = r;
      near_shift_[k] = hn::Sub(shift, wide_slack);
      far_shift_[k] = hn::Add(shift, wide_slack);
      gate_near_shift_[k] = hn::Sub(shift, slack);
      gate_far_shift_[k] = hn::Add(shift, slack);
      slack_[k] = hn::GetLane(hn::MaxOfLanes(d, slack)) * (box_slack + 0.5f);
    }
    limit_ = hn::Add(t_max, hn::Zero(d));
    key_ = hn::Set(DIB(), kNoKey);
    block_ = hn::Set(DIB(), -1);
    lane_ = hn::Zero(DIB());
    return true;
  }

  // All together: where the rays begin, how they go, how much slack a box of theirs needs at most, and from
  // where to where they may still hit anything.
  Range origins(int k) const { return Range(origin_[k]); }
  Range inverses(int k) const { return Range(inverse_[k]); }
  float slack(int k) const { return slack_[k]; }
  float first_t() const { return hn::GetLane(hn::MinOfLanes(DB(), t_min_)); }
  float last_t() const { return hn::GetLane(hn::MaxOfLanes(DB(), limit_)); }
  /// Where the near and the far planes lie in a node, in bytes.
  int near_row(int k) const { return near_row_[k]; }
  int far_row(int k) const { return far_row_[k]; }

  /// The rays that enter the box of a child.
  template <class Layout>
  HWY_INLINE MB test_box(const char* node, std::uint32_t child) const {
    const DB d;
    const DIB di;
    const typename Layout::Planes planes(node);
    VIB entry = hn::BitCast(di, t_min_), exit = hn::BitCast(di, limit_);
    for (int k = 0; k < 3; ++k) {
      const VB near = hn::Set(d, planes.plane(k, near_row_[k], child));
      const VB far = hn::Set(d, planes.plane(k, far_row_[k], child));
      entry = hn::Max(entry, hn::BitCast(di, hn::MulAdd(near, inverse_[k], near_shift_[k])));
      exit = hn::Min(exit, hn::BitCast(di, hn::MulAdd(far, inverse_[k], far_shift_[k])));
    }
    return hn::Le(hn::BitCast(d, entry), hn::BitCast(d, exit));
  }

  /// Takes the crossings of the triangles of the block at `at` by the rays of `active`.
  HWY_INLINE void test_block(const TriangleBlock& block, std::uint32_t at, MB active) {
    // The edges of all four before the first branch: most triangles are missed by all rays, and which are not
    // is hard to foresee.
    VB products[kBlockWidth];
    std::uint32_t crossed = 0;
    for (int lane = 0; lane < kBlockWidth; ++lane) {
      products[lane] = test_edges(block, lane);
      const MB maybe = hn::AndNot(hn::Lt(products[lane], hn::Zero(DB())), active);
      crossed |= static_cast<std::uint32_t>(!hn::AllFalse(DB(), maybe)) << lane;
    }
    if (crossed == 0) return;
    const Faces faces(block, axis_);
    for (; crossed; crossed &= crossed - 1) {
      const int lane = __builtin_ctz(crossed);
      test_plane(block, at, faces, lane, products[lane], active);
    }
  }

  /// Writes what was found; the t of a miss is +inf.
  HWY_INLINE void store(TriangleHit* hits) const {
    const DB d;
    const auto is_hit = hn::RebindMask(d, hn::Ne(block_, hn::Set(DIB(), -1)));
    hn::StoreInterleaved4(hn::IfThenElse(is_hit, limit_, hn::Set(d, kInfinity)),
                          hn::BitCast(d, hn::Xor(key_, hn::Set(DIB(), kTurned))), hn::BitCast(d, block_),
                          hn::BitCast(d, lane_), d, &hits->t);
  }
  HWY_INLINE void store(bool* is_hit) const {
    HWY_ALIGN std::int32_t block[kBundle];
    hn::Store(block_, DIB(), block);
    for (int i = 0; i < kBundle; ++i) is_hit[i] = block[i] != -1;
  }

 private:
  /// A lane for each ray from the eight floats of each.
  static HWY_INLINE void load(const Ray* rays, VB (&origin)[3], VB& t_min, VB (&dir)[3], VB& t_max) {
    // Half of the rays at a time: lanes are an origin's and a direction's in turn.
    const DB d;
    const float* first = &rays->origin.x;
    VB lower[4], upper[4];
    hn::LoadInterleaved4(d, first, lower[0], lower[1], lower[2], lower[3]);
    hn::LoadInterleaved4(d, first + 4 * kBundle, upper[0], upper[1], upper[2], upper[3]);
    for (int k = 0; k < 3; ++k) {
      origin[k] = hn::ConcatEven(d, upper[k], lower[k]);
      dir[k] = hn::ConcatOdd(d, upper[k], lower[k]);
    }
    t_min = hn::ConcatEven(d, upper[3], lower[3]);
    t_max = hn::ConcatOdd(d, upper[3], lower[3]);
  }

  /// Keys are compared as signed numbers, with the highest bit turned round: so no key is the largest.
  static constexpr std::int32_t kTurned = std::numeric_limits<std::int32_t>::min();
  static constexpr std::int32_t kNoKey = std::numeric_limits<std::int32_t>::max();

  /// test_edges() of one triangle for all rays: below 0 it is missed, above 0 crossed.
  HWY_INLINE VB test_edges(const TriangleBlock& block, int lane) const {
    const DB d;
    const int kx = axis_[0], ky = axis_[1], kz = axis_[2];
    const auto from_vertex = [&](int v, int axis) {
      return hn::Sub(origin_[axis], hn::Set(d, block.v[v][axis][lane]));
    };
    const VB az = from_vertex(0, kz), bz = from_vertex(1, kz), cz = from_vertex(2, kz);
    const VB ax = hn::Sub(from_vertex(0, kx), hn::Mul(shear_[0], az));
    const VB ay = hn::Sub(from_vertex(0, ky), hn::Mul(shear_[1], az));
    const VB bx = hn::Sub(from_vertex(1, kx), hn::Mul(shear_[0], bz));
    const VB by = hn::Sub(from_vertex(1, ky), hn::Mul(shear_[1], bz));
    const VB cx = hn::Sub(from_vertex(2, kx), hn::Mul(shear_[0], cz));
    const VB cy = hn::Sub(from_vertex(2, ky), hn::Mul(shear_[1], cz));
    const VB wa = hn::Sub(hn::Mul(bx, cy), hn::Mul(by, cx));
    const VB wb = hn::Sub(hn::Mul(cx, ay), hn::Mul(cy, ax));
    const VB wc = hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx));
    return hn::Mul(hn::Min(wa, hn::Min(wb, wc)), hn::Max(wa, hn::Max(wb, wc)));
  }

  /// What the planes of a block's triangles need and no ray changes: normals, with the axes in the order of
  /// the triangle test, and boxes.
  struct Faces {
    HWY_ALIGN float normal[3][kBlockWidth];
    HWY_ALIGN float edge_on[kBlockWidth];  // the steepest slope that is edge-on
    HWY_ALIGN float bounds[3][2][kBlockWidth];

    HWY_INLINE Faces(const TriangleBlock& block, const int (&axis)[3]) {
      const D4 d;
      const auto row = [&](int v, int k) { return hn::Load(d, block.v[v][k]); };
      V4 e1[3], e2[3];
      for (int i = 0; i < 3; ++i) {
        const V4 a = row(0, axis[i]);
        e1[i] = hn::Sub(row(1, axis[i]), a);
        e2[i] = hn::Sub(row(2, axis[i]), a);
      }
      V4 products[3];
      for (int i = 0; i < 3; ++i) {
        const int p = (i + 1) % 3, q = (i + 2) % 3;
        const V4 pq = hn::Mul(e1[p], e2[q]), qp = hn::Mul(e1[q], e2[p]);
        hn::Store(hn::Sub(pq, qp), d, normal[i]);
        products[i] = hn::Add(hn::Abs(pq), hn::Abs(qp));
      }
      const V4 all = hn::Add(hn::Add(products[0], products[1]), products[2]);
      hn::Store(hn::Max(hn::Mul(all, hn::Set(d, kEdgeOn)), hn::Set(d, 0x1p-80f)), d, edge_on);
      for (int k = 0; k < 3; ++k) {
        const V4 a = row(0, k), b = row(1, k), c = row(2, k);
        hn::Store(hn::Min(a, hn::Min(b, c)), d, bounds[k][0]);
        hn::Store(hn::Max(a, hn::Max(b, c)), d, bounds[k][1]);
      }
    }
  };

  /// test_planes() of one triangle for the rays of `active` that cross it by `product`.
  HWY_INLINE void test_plane(const TriangleBlock& block, std::uint32_t at, const Faces& faces, int lane,
                             VB product, MB active) {
    const DB d;
    const DIB di;
    const auto maybe = hn::AndNot(hn::Lt(product, hn::Zero(d)), active);
    const auto from_a = [&](int axis) { return hn::Sub(origin_[axis], hn::Set(d, block.v[0][axis][lane])); };
    const VB nx = hn::Set(d, faces.normal[0][lane]), ny = hn::Set(d, faces.normal[1][lane]),
             nz = hn::Set(d, faces.normal[2][lane]);
    const VB height = hn::Add(hn::Add(hn::Mul(nx, from_a(axis_[0])), hn::Mul(ny, from_a(axis_[1]))),
                              hn::Mul(nz, from_a(axis_[2])));
    const VB slope = hn::Add(hn::Add(hn::Mul(nx, shear_[0]), hn::Mul(ny, shear_[1])), nz);
    VB t = hn::Add(hn::Div(hn::Mul(hn::Neg(shear_[2]), height), slope), hn::Zero(d));
    const auto ordinary =
        hn::And(hn::And(hn::Lt(hn::Abs(t), hn::Set(d, kInfinity)), hn::Gt(product, hn::Zero(d))),
                hn::Gt(hn::Abs(slope), hn::Set(d, faces.edge_on[lane])));
    auto crossed = hn::And(maybe, ordinary);
    const auto undecided = hn::AndNot(ordinary, maybe);
    if (HWY_UNLIKELY(!hn::AllFalse(d, undecided)))
      crossed = hn::Or(crossed, resolve(block.triangle(static_cast<std::uint32_t>(lane)), undecided, t));

    // The gate (shape/gate.h). All rays meet the planes from the same sides.
    VB entry = hn::Set(d, -kInfinity), exit = hn::Set(d, kInfinity);
    for (int k = 0; k < 3; ++k) {
      const bool is_backward = near_row_[k] & kRowBytes;
      const VB near = hn::Set(d, faces.bounds[k][is_backward][lane]);
      const VB far = hn::Set(d, faces.bounds[k][!is_backward][lane]);
      entry = hn::Max(entry, hn::Add(hn::Mul(near, inverse_[k]), gate_near_shift_[k]));
      exit = hn::Min(exit, hn::Add(hn::Mul(far, inverse_[k]), gate_far_shift_[k]));
    }
    t = hn::Add(hn::Min(hn::Max(t, entry), exit), hn::Zero(d));
    const auto in_range = hn::And(hn::Le(entry, exit), hn::And(hn::Ge(t, t_min_), hn::Le(t, limit_)));
    const auto key = hn::Set(di, static_cast<std::int32_t>(block.key[lane]) ^ kTurned);
    const auto comes_first = hn::Or(hn::Lt(t, limit_), hn::RebindMask(d, hn::Lt(key, key_)));
    const auto taken = hn::And(hn::And(crossed, in_range), comes_first);

    const auto taken_i = hn::RebindMask(di, taken);
    limit_ = hn::IfThenElse(taken, kAny ? hn::Set(d, -kInfinity) : t, limit_);
    key_ = hn::IfThenElse(taken_i, key, key_);
    block_ = hn::IfThenElse(taken_i, hn::Set(di, static_cast<std::int32_t>(at)), block_);
    lane_ = hn::IfThenElse(taken_i, hn::Set(di, lane), lane_);
  }

  /// Asks the scalar test about each ray of `undecided`; writes into `t`.
  HWY_NOINLINE MB resolve(const Triangle& triangle, MB undecided, VB& t) const {
    const DB d;
    HWY_ALIGN float origin[3][kBundle], shear[3][kBundle], ts[kBundle], crossed[kBundle];
    for (int k = 0; k < 3; ++k) {
      hn::Store(origin_[k], d, origin[k]);
      hn::Store(shear_[k], d, shear[k]);
    }
    hn::Store(t, d, ts);
    hn::Store(hn::VecFromMask(d, undecided), d, crossed);
    for (int i = 0; i < kBundle; ++i) {
      const bool asked = std::bit_cast<std::uint32_t>(crossed[i]) != 0;
      crossed[i] = 0;
      if (!asked) continue;
      RayShear one;
      one.origin = {origin[0][i], origin[1][i], origin[2][i]};
      one.axis_x = axis_[0], one.axis_y = axis_[1], one.axis_z = axis_[2];
      one.shear_x = shear[0][i], one.shear_y = shear[1][i], one.shear_z = shear[2][i];
      Crossing crossing;
      if (!intersect_triangle(one, triangle.a, triangle.b, triangle.c, crossing)) continue;
      ts[i] = crossing.t;
      crossed[i] = 1;
    }
    t = hn::Load(d, ts);
    return hn::Gt(hn::Load(d, crossed), hn::Zero(d));
  }

  // A lane for each ray.
  VB origin_[3], shear_[3], t_min_, limit_;
  VB inverse_[3], near_shift_[3], far_shift_[3], gate_near_shift_[3], gate_far_shift_[3];
  VIB key_, block_, lane_;

  // All together.
  int axis_[3], near_row_[3], far_row_[3];
  float slack_[3];
};

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
