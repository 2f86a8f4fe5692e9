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

template <bool kAny>
class Bundle {
 public:
  /// Written out: gcc compiles an implicit one for the plain machine, where vectors cannot be made.
  HWY_INLINE Bundle() {}
  /// Takes kBundle rays; false when they do not go the same way, or are not all ordinary.
  HWY_INLINE bool prepare(const Ray* rays, const Box3& bounds) {
    const DB d;
    const VIB stride = hn::Mul(hn::Iota(DIB(), 0), hn::Set(DIB(), 8));
    const float* first = &rays->origin.x;
    const auto field = [&](int i) { return hn::GatherIndex(d, first + i, stride); };

    // As in prepare() for one ray (ray-inl.h), a lane for each ray.
    VB dir[3], abs_dir[3], reach = hn::Zero(d);
    auto ordinary = hn::Eq(reach, reach);
    for (int k = 0; k < 3; ++k) {
      origin_[k] = field(k);
      dir[k] = field(4 + k);
      abs_dir[k] = hn::Abs(dir[k]);
      const VB to_corner = hn::Max(hn::Abs(hn::Sub(hn::Set(d, bounds.lower[k]), origin_[k])),
                                   hn::Abs(hn::Sub(hn::Set(d, bounds.upper[k]), origin_[k])));
      ordinary = hn::And(ordinary, hn::Le(hn::Add(abs_dir[k], to_corner), hn::Set(d, kLargestReach)));
      reach = hn::Max(reach, to_corner);
    }
    const VB t_min = field(3), t_max = field(7);
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

    // The slabs, and the shear.
    constexpr float u = 0x1p-24f;
    const VB least = hn::Mul(d_max, hn::Set(d, 0x1p-30f)), tiny = hn::Set(d, 0x1p-140f);
    for (int k = 0; k < 3; ++k) {
      const VB r = hn::Div(hn::Set(d, 1.0f), hn::CopySign(hn::Max(abs_dir[k], least), dir[k]));
      const VB error =
          hn::Add(hn::Mul(hn::Set(d, 12 * u), reach), hn::Mul(hn::Set(d, 8 * u), hn::Abs(origin_[k])));
      slack_[k] = hn::Add(hn::Mul(hn::Abs(r), hn::Add(error, tiny)), tiny);
      shift_[k] = hn::Neg(hn::Mul(origin_[k], r));
      inverse_[k] = r;
    }
    shear_[2] = inverse_[z];
    shear_[0] = hn::Mul(dir[axis_[0]], shear_[2]);
    shear_[1] = hn::Mul(dir[axis_[1]], shear_[2]);

    // Whether they stay together: one after the other in a picture, not scattered by a surface.
    constexpr float kSpread = 0.1f;
    if (Range(shear_[0]).size() > kSpread || Range(shear_[1]).size() > kSpread) return false;
    const float far_away = hn::GetLane(reach);
    for (int k = 0; k < 3; ++k) {
      const Range origins(origin_[k]), inverses(inverse_[k]);
      if (origins.size() > far_away * 0x1p-8f) return false;
      set_interval(k, origins, inverses, hn::GetLane(hn::MaxOfLanes(d, slack_[k])));
    }
    limit_ = hn::Add(t_max, hn::Zero(d));
    first_t_ = hn::GetLane(hn::MinOfLanes(d, t_min_));
    last_t_ = hn::GetLane(hn::MaxOfLanes(d, limit_));
    key_ = hn::Set(DIB(), kNoKey);
    block_ = hn::Set(DIB(), -1);
    lane_ = hn::Zero(DIB());
    return true;
  }

  void trace(const char* pool) {
    HWY_ALIGN std::int32_t keys[kStackSize], refs[kStackSize];
    std::size_t top = 0;  // entries below; a reference is that of the parent and the child's place in it
    top = push(pool, 0, keys, refs);
    while (top > 0) {
      --top;
      if (keys[top] > (std::bit_cast<std::int32_t>(last_t_) | 7)) continue;
      const auto parent = static_cast<std::uint32_t>(refs[top]) & ~15u;
      const std::uint32_t child = static_cast<std::uint32_t>(refs[top]) & 7;
      const char* node = node_at(pool, parent);
      const MB active = test_box(node, child);
      if (hn::AllFalse(DB(), active)) continue;
      const auto ref = reinterpret_cast<const std::uint32_t*>(node + 6 * kRowBytes)[child];
      if ((ref & 3) == 0) {
        top += push(pool, ref, keys + top, refs + top);
        continue;
      }
      const TriangleBlock* block = block_at(pool, ref);
      for (std::uint32_t left = ref >> 2 & 3; left > 0; --left, ++block)
        for (int lane = 0; lane < kBlockWidth; ++lane) {
          if (lane > 0 && block->key[lane] == block->key[0]) break;
          test_triangle(*block, lane, pool, active);
        }
      last_t_ = hn::GetLane(hn::MaxOfLanes(DB(), limit_));
      if (kAny && last_t_ < 0) return;
    }
  }

  /// Calls output(i, hit) for each ray; hit.t is t_max, or the crossing's.
  template <class Output>
  HWY_INLINE void finish(const Output& output) const {
    HWY_ALIGN float t[kBundle];
    HWY_ALIGN std::uint32_t key[kBundle], block[kBundle], lane[kBundle];
    const hn::RebindToUnsigned<DIB> du;
    hn::Store(limit_, DB(), t);
    hn::Store(hn::BitCast(du, hn::Xor(key_, hn::Set(DIB(), kTurned))), du, key);
    hn::Store(hn::BitCast(du, block_), du, block);
    hn::Store(hn::BitCast(du, lane_), du, lane);
    for (std::uint32_t i = 0; i < kBundle; ++i) output(i, TriangleHit{t[i], key[i], block[i], lane[i]});
  }

 private:
  /// Keys are compared as signed numbers, with the highest bit turned round: so no key is the largest.
  static constexpr std::int32_t kTurned = std::numeric_limits<std::int32_t>::min();
  static constexpr std::int32_t kNoKey = std::numeric_limits<std::int32_t>::max();

  /// The constants with which no plane is met before the first ray meets it, nor left after the last has left
  /// it. The products are taken at both ends of the interval; the slack is doubled for their rounding.
  HWY_INLINE void set_interval(int k, Range origins, Range inverses, float slack) {
    const DW d;
    const bool is_backward = inverses.high < 0;
    const float near_origin = is_backward ? origins.low : origins.high;
    const float far_origin = is_backward ? origins.high : origins.low;
    slack = slack * 2 + 0x1p-120f;
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
    const char* node = node_at(pool, ref);
    VIW entry = hn::BitCast(di, hn::Set(d, first_t_)), exit = hn::BitCast(di, hn::Set(d, last_t_));
    for (int k = 0; k < 3; ++k) {
      const VW near = hn::Load(d, reinterpret_cast<const float*>(node + near_row_[k]));
      const VW far = hn::Load(d, reinterpret_cast<const float*>(node + far_row_[k]));
      entry = hn::Max(entry, hn::BitCast(di, hn::Min(hn::MulAdd(near, low_inverse_[k], near_low_[k]),
                                                     hn::MulAdd(near, high_inverse_[k], near_high_[k]))));
      exit = hn::Min(exit, hn::BitCast(di, hn::Max(hn::MulAdd(far, low_inverse_[k], far_low_[k]),
                                                   hn::MulAdd(far, high_inverse_[k], far_high_[k]))));
    }
    const auto enters = hn::RebindMask(di, hn::Le(hn::BitCast(d, entry), hn::BitCast(d, exit)));
    const std::size_t count = hn::CountTrue(di, enters);
    const VIW sorted =
        sort_all_descending(di, hn::Compress(hn::IfThenElseZero(enters, make_keys(entry)), enters));
    hn::StoreU(sorted, di, keys);
    hn::StoreU(hn::Or(hn::And(sorted, hn::Set(di, 7)), hn::Set(di, static_cast<std::int32_t>(ref))), di,
               refs);
    return count;
  }

  /// The rays that enter a child's box.
  HWY_INLINE MB test_box(const char* node, std::uint32_t child) const {
    const DB d;
    const DIB di;
    VIB entry = hn::BitCast(di, t_min_), exit = hn::BitCast(di, limit_);
    for (int k = 0; k < 3; ++k) {
      const VB near = hn::Set(d, reinterpret_cast<const float*>(node + near_row_[k])[child]);
      const VB far = hn::Set(d, reinterpret_cast<const float*>(node + far_row_[k])[child]);
      const VB box_slack = hn::Add(hn::Mul(slack_[k], hn::Set(d, 1.5f)), hn::Set(d, 0x1p-120f));
      entry = hn::Max(entry, hn::BitCast(di, hn::MulAdd(near, inverse_[k], hn::Sub(shift_[k], box_slack))));
      exit = hn::Min(exit, hn::BitCast(di, hn::MulAdd(far, inverse_[k], hn::Add(shift_[k], box_slack))));
    }
    return hn::Le(hn::BitCast(d, entry), hn::BitCast(d, exit));
  }

  /// Takes the crossings of one triangle by the rays of `active`.
  HWY_INLINE void test_triangle(const TriangleBlock& block, int lane, const char* pool, MB active) {
    const DB d;
    const DIB di;
    const int kx = axis_[0], ky = axis_[1], kz = axis_[2];
    const auto vertex = [&](int v, int axis) { return hn::Set(d, block.v[v][axis][lane]); };
    const VB ox = origin_[kx], oy = origin_[ky], oz = origin_[kz];

    // The signs of the edge functions: test_edges().
    const VB tax = hn::Sub(ox, vertex(0, kx)), tay = hn::Sub(oy, vertex(0, ky)),
             taz = hn::Sub(oz, vertex(0, kz));
    const VB tbz = hn::Sub(oz, vertex(1, kz)), tcz = hn::Sub(oz, vertex(2, kz));
    const VB ax = hn::Sub(tax, hn::Mul(shear_[0], taz)), ay = hn::Sub(tay, hn::Mul(shear_[1], taz));
    const VB bx = hn::Sub(hn::Sub(ox, vertex(1, kx)), hn::Mul(shear_[0], tbz));
    const VB by = hn::Sub(hn::Sub(oy, vertex(1, ky)), hn::Mul(shear_[1], tbz));
    const VB cx = hn::Sub(hn::Sub(ox, vertex(2, kx)), hn::Mul(shear_[0], tcz));
    const VB cy = hn::Sub(hn::Sub(oy, vertex(2, ky)), hn::Mul(shear_[1], tcz));
    const VB wa = hn::Sub(hn::Mul(bx, cy), hn::Mul(by, cx));
    const VB wb = hn::Sub(hn::Mul(cx, ay), hn::Mul(cy, ax));
    const VB wc = hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx));
    const VB product = hn::Mul(hn::Min(wa, hn::Min(wb, wc)), hn::Max(wa, hn::Max(wb, wc)));
    const auto maybe = hn::AndNot(hn::Lt(product, hn::Zero(d)), active);
    if (hn::AllFalse(d, maybe)) return;

    // Where the lines meet the plane: test_planes().
    const Triangle triangle = block.triangle(static_cast<std::uint32_t>(lane));
    const Vec3 n = cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const VB nx = hn::Set(d, n[kx]), ny = hn::Set(d, n[ky]), nz = hn::Set(d, n[kz]);
    const VB height = hn::Add(hn::Add(hn::Mul(nx, tax), hn::Mul(ny, tay)), hn::Mul(nz, taz));
    const VB slope = hn::Add(hn::Add(hn::Mul(nx, shear_[0]), hn::Mul(ny, shear_[1])), nz);
    VB t = hn::Add(hn::Div(hn::Mul(hn::Neg(shear_[2]), height), slope), hn::Zero(d));
    const auto ordinary =
        hn::And(hn::And(hn::Lt(hn::Abs(t), hn::Set(d, kInfinity)), hn::Gt(product, hn::Zero(d))),
                hn::Gt(hn::Abs(slope), hn::Set(d, 0x1p-80f)));
    auto crossed = hn::And(maybe, ordinary);
    const auto undecided = hn::AndNot(ordinary, maybe);
    if (HWY_UNLIKELY(!hn::AllFalse(d, undecided))) crossed = hn::Or(crossed, resolve(triangle, undecided, t));

    // The gate (shape/gate.h). All rays meet the planes from the same sides.
    const Box3 box = triangle.box();
    VB entry = hn::Set(d, -kInfinity), exit = hn::Set(d, kInfinity);
    for (int k = 0; k < 3; ++k) {
      const bool is_backward = near_row_[k] & kRowBytes;
      const VB near = hn::Set(d, is_backward ? box.upper[k] : box.lower[k]);
      const VB far = hn::Set(d, is_backward ? box.lower[k] : box.upper[k]);
      entry = hn::Max(entry, hn::Add(hn::Mul(near, inverse_[k]), hn::Sub(shift_[k], slack_[k])));
      exit = hn::Min(exit, hn::Add(hn::Mul(far, inverse_[k]), hn::Add(shift_[k], slack_[k])));
    }
    t = hn::Add(hn::Min(hn::Max(t, entry), exit), hn::Zero(d));
    const auto in_range = hn::And(hn::Le(entry, exit), hn::And(hn::Ge(t, t_min_), hn::Le(t, limit_)));
    const auto key = hn::Set(di, static_cast<std::int32_t>(block.key[lane]) ^ kTurned);
    const auto comes_first = hn::Or(hn::Lt(t, limit_), hn::RebindMask(d, hn::Lt(key, key_)));
    const auto taken = hn::And(hn::And(crossed, in_range), comes_first);
    if (hn::AllFalse(d, taken)) return;

    const auto taken_i = hn::RebindMask(di, taken);
    const auto at = static_cast<std::int32_t>((reinterpret_cast<const char*>(&block) - pool) / 32);
    limit_ = hn::IfThenElse(taken, kAny ? hn::Set(d, -kInfinity) : t, limit_);
    key_ = hn::IfThenElse(taken_i, key, key_);
    block_ = hn::IfThenElse(taken_i, hn::Set(di, at), block_);
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
  VB origin_[3], inverse_[3], shift_[3], slack_[3], shear_[3], t_min_, limit_;
  VIB key_, block_, lane_;

  // All together.
  int axis_[3], near_row_[3], far_row_[3];
  VW low_inverse_[3], high_inverse_[3], near_low_[3], near_high_[3], far_low_[3], far_high_[3];
  float first_t_, last_t_;
};

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
