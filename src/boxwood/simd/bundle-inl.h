// bundle-inl.h: rays that go the same way, together through a tree. Compiled once for each instruction set.
//
// Neighbouring rays of a camera visit nearly the same nodes. A bundle is a vector of such rays. A node is
// tested once for all of them, against the interval that holds all their constants (Boulos et al., "Geometric
// and Arithmetic Culling Methods for Entire Ray Packets", 2006); a child that comes off the stack is tested
// against the rays one by one, all lanes at once, with what they have hit by then; a triangle of a leaf too.

#if defined(BOXWOOD_SIMD_BUNDLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_BUNDLE_INL_H
#undef BOXWOOD_SIMD_BUNDLE_INL_H
#else
#define BOXWOOD_SIMD_BUNDLE_INL_H
#endif

#include "boxwood/simd/bundle_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

inline constexpr std::size_t kFetchedAhead = 3;  // children of a node

template <class Layout, bool kAny>
class Bundle {
 public:
  /// As for BundleRays.
  HWY_INLINE Bundle() {}
  /// Takes kBundle rays; false when they do not go the same way, or are not all ordinary.
  HWY_INLINE bool prepare(const Ray* rays, const Box3& bounds, float box_slack) {
    if (!rays_.prepare(rays, bounds, box_slack)) return false;
    for (int k = 0; k < 3; ++k) set_interval(k);
    first_t_ = rays_.first_t();
    last_t_ = rays_.last_t();
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
    const MB active = rays_.template test_box<Layout>(node, child);
    if (hn::AllFalse(DB(), active)) return true;
    const auto ref = static_cast<std::uint32_t>(children_of<Layout>(node)[child]);
    if ((ref & 3) == 0) {
      top_ += push(pool, ref, keys_ + top_, refs_ + top_);
      return true;
    }
    const char* block = blocks_at(pool, ref);
    for (std::uint32_t left = ref >> 2 & 3; left > 0; --left, block += Layout::kBlockBytes)
      rays_.test_block(Layout::block(block), units(pool, block), active);
    last_t_ = rays_.last_t();
    if (kAny && last_t_ < 0) top_ = 0;
    return true;
  }

  /// Writes what was found; the t of a miss is +inf.
  template <class Found>
  HWY_INLINE void store(Found* found) const {
    rays_.store(found);
  }

 private:
  /// The constants with which no plane is met before the first ray meets it, nor left after the last has left
  /// it. The products are taken at both ends of the interval; the slack is half as large again for their
  /// rounding.
  HWY_INLINE void set_interval(int k) {
    const DW d;
    const Range origins = rays_.origins(k), inverses = rays_.inverses(k);
    const bool is_backward = inverses.high < 0;
    const float near_origin = is_backward ? origins.low : origins.high;
    const float far_origin = is_backward ? origins.high : origins.low;
    const float slack = rays_.slack(k) + 0x1p-120f;
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
      const VW near = planes.row(k, rays_.near_row(k)), far = planes.row(k, rays_.far_row(k));
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

  BundleRays<kAny> rays_;
  // An entry of the stack is a reference of the parent and the child's place in it.
  std::size_t top_;  // entries below
  HWY_ALIGN std::int32_t keys_[kStackSize], refs_[kStackSize];
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
