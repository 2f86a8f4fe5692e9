// bundle-inl.h: rays that go the same way, together through a tree. Compiled once for each instruction set.
//
// Neighbouring rays of a camera visit nearly the same nodes. A bundle is a vector of such rays, one in each
// lane. A node is tested once for all of them, against the interval that holds all their constants (Boulos et
// al., "Geometric and Arithmetic Culling Methods for Entire Ray Packets", 2006); a child that comes off the
// stack is tested against the rays one by one, all lanes at once, with what they have hit by then; a triangle
// of a leaf too. The operations of a lane are those of prepare(), test_edges() and test_planes(), in the same
// order: the same bits.

#if defined(BOXWOOD_SIMD_BUNDLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_BUNDLE_INL_H
#undef BOXWOOD_SIMD_BUNDLE_INL_H
#else
#define BOXWOOD_SIMD_BUNDLE_INL_H
#endif

#include "boxwood/simd/single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

inline constexpr int kBundle = HWY_MAX_BYTES / 4 < 16 ? HWY_MAX_BYTES / 4 : 16;  // rays
inline constexpr std::size_t kFetchedAhead = 3;                                  // children of a node

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
  float size() const { return high - low; }
};

template <class Layout, bool kAny>
class Bundle {
 public:
  /// Written out: gcc compiles an implicit one for the plain machine, where vectors cannot be made.
  HWY_INLINE Bundle() {}
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
      set_interval(k, Range(origin_[k]), Range(r),
                   hn::GetLane(hn::MaxOfLanes(d, slack)) * (box_slack + 0.5f));
    }
    limit_ = hn::Add(t_max, hn::Zero(d));
    first_t_ = hn::GetLane(hn::MinOfLanes(d, t_min_));
    last_t_ = hn::GetLane(hn::MaxOfLanes(d, limit_));
    key_ = hn::Set(DIB(), kNoKey);
    block_ = hn::Set(DIB(), -1);
    lane_ = hn::Zero(DIB());
    return true;
  }

  /// Puts the children of the root on the stack.
  HWY_INLINE void start(const char* pool) { top_ = push(pool, 0, keys_, refs_); }

  /// Takes a child off the stack and sees to it; false when there is none left.
  HWY_INLINE bool step(const char* pool) {
    if (top_ == 0) return false;
    --top_;
    if (keys_[top_] > (std::bit_cast<std::int32_t>(last_t_) | kChildBits)) return true;
    const auto parent = static_cast<std::uint32_t>(refs_[top_]) & ~15u;
    const std::uint32_t child = static_cast<std::uint32_t>(refs_[top_] & kChildBits);
    const char* node = node_at(pool, parent);
    const MB active = test_box(node, child);
    if (hn::AllFalse(DB(), active)) return true;
    const auto ref = static_cast<std::uint32_t>(children_of<Layout>(node)[child]);
    if ((ref & 3) == 0) {
      top_ += push(pool, ref, keys_ + top_, refs_ + top_);
      return true;
    }
    const char* block = blocks_at(pool, ref);
    for (std::uint32_t left = ref >> 2 & 3; left > 0; --left, block += Layout::kBlockBytes)
      test_block(Layout::block(block), units(pool, block), active);
    last_t_ = hn::GetLane(hn::MaxOfLanes(DB(), limit_));
    if (kAny && last_t_ < 0) top_ = 0;
    return true;
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

  /// The constants with which no plane is met before the first ray meets it, nor left after the last has left
  /// it. The products are taken at both ends of the interval; the slack is half as large again for their
  /// rounding.
  HWY_INLINE void set_interval(int k, Range origins, Range inverses, float slack) {
    const DW d;
    const bool is_backward = inverses.high < 0;
    const float near_origin = is_backward ? origins.low : origins.high;
    const float far_origin = is_backward ? origins.high : origins.low;
    slack += 0x1p-120f;
    low_inverse_[k] = hn::Set(d, inverses.low);
    high_inverse_[k] = hn::Set(d, inverses.high);
    near_low_[k] = hn::Set(d, -near_origin * inverses.low - slack);
    near_high_[k] = hn::Set(d, -near_origin * inverses.high - slack);
    far_low_[k] = hn::Set(d, -far_origin * inverses.low + slack);
    far_high_[k] = hn::Set(d, -far_origin * inverses.high + slack);
  }

  /// Puts the children of a node that any ray may enter on the stack, the farthest first. Returns how many
  /// they are.
  HWY_INLINE std::size_t push(const char* pool, std::uint32_t ref, std::int32_t* keys,
                              std::int32_t* refs) const {
    const DW d;
    const DIW di;
    const typename Layout::Planes planes(node_at(pool, ref));
    VIW entry = hn::BitCast(di, hn::Set(d, first_t_)), exit = hn::BitCast(di, hn::Set(d, last_t_));
    for (int k = 0; k < 3; ++k) {
      const VW near = planes.row(k, near_row_[k]), far = planes.row(k, far_row_[k]);
      entry = hn::Max(entry, hn::BitCast(di, hn::Min(hn::MulAdd(near, low_inverse_[k], near_low_[k]),
                                                     hn::MulAdd(near, high_inverse_[k], near_high_[k]))));
      exit = hn::Min(exit, hn::BitCast(di, hn::Max(hn::MulAdd(far, low_inverse_[k], far_low_[k]),
                                                   hn::MulAdd(far, high_inverse_[k], far_high_[k]))));
    }
    const auto enters = hn::RebindMask(di, hn::Le(hn::BitCast(d, entry), hn::BitCast(d, exit)));
    const std::size_t count = hn::CountTrue(di, enters);
    const VIW sorted =
        sort_all_descending(di, compress(di, hn::IfThenElseZero(enters, make_keys(entry)), enters));
    hn::StoreU(sorted, di, keys);
    hn::StoreU(hn::Or(hn::And(sorted, hn::Set(di, kChildBits)), hn::Set(di, static_cast<std::int32_t>(ref))),
               di, refs);

    // The other bundle's turn comes first: time to fetch what is next.
    const std::int32_t* children = children_of<Layout>(node_at(pool, ref));
    for (std::size_t i = count > kFetchedAhead ? count - kFetchedAhead : 0; i < count; ++i)
      prefetch_lines<Layout::kNodeLines>(
          node_at(pool, static_cast<std::uint32_t>(children[refs[i] & kChildBits])));
    return count;
  }

  /// The rays that enter a child's box.
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

  // All together. An entry of the stack is a reference of the parent and the child's place in it.
  std::size_t top_;  // entries below
  HWY_ALIGN std::int32_t keys_[kStackSize], refs_[kStackSize];
  int axis_[3], near_row_[3], far_row_[3];
  VW low_inverse_[3], high_inverse_[3], near_low_[3], near_high_[3], far_low_[3], far_high_[3];
  float first_t_, last_t_;
};

/// Traces two bundles in turns, so that one works while the other waits; or one alone.
template <class Bundle>
HWY_NOINLINE void trace_bundles(const char* pool, std::span<Bundle> bundles) {
  for (Bundle& bundle : bundles) bundle.start(pool);
  if (bundles.size() == 2)
    while (bundles[0].step(pool) && bundles[1].step(pool)) {
    }
  for (Bundle& bundle : bundles)
    while (bundle.step(pool)) {
    }
}

/// Whether it is worth a closer look if kBundle rays go the same way: the first and the last do.
HWY_INLINE bool may_be_bundle(const Ray* rays) {
  const D4 d;
  const Ray &first = rays[0], &last = rays[kBundle - 1];
  const V4 turn = hn::Abs(hn::Sub(hn::LoadU(d, &first.direction.x), hn::LoadU(d, &last.direction.x)));
  const V4 size = hn::Abs(hn::LoadU(d, &first.direction.x));
  return hn::AllTrue(d, hn::Or(hn::Le(turn, hn::Mul(largest(without_fourth(size)), hn::Set(d, 0.1f))),
                               hn::Not(hn::FirstN(d, 3))));
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
