// interleave-inl.h: many independent rays through a tree, on one thread. Compiled once for each instruction
// set.
//
// A single ray waits most of its time: for the chain of its own operations, for the cache, for a mispredicted
// branch. Here kInFlight rays take turns. A turn is one step without branches: test a node's children, put
// those that are entered on the ray's stack, prefetch what is now on top, and go on with another ray. (In
// databases: asynchronous memory access chaining, Kocberber et al., VLDB 2015.) What a ray stands before
// decides on which of three lists it waits: nodes, leaves, or done; each list is worked off by a loop that
// does one thing, so that there is little to mispredict.

#if defined(BOXWOOD_SIMD_INTERLEAVE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_INTERLEAVE_INL_H
#undef BOXWOOD_SIMD_INTERLEAVE_INL_H
#else
#define BOXWOOD_SIMD_INTERLEAVE_INL_H
#endif

#include <memory>

#include "boxwood/simd/single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

inline constexpr int kInFlight = 32;
/// When no more rays than this stand before a node, the others are seen to.
inline constexpr int kFewNodes = 16;

/// Enough for 16 levels of sixteen children, or 17 of eight; deeper trees take one ray at a time.
inline constexpr int kShortStack = kWidth > 8 ? 264 : 128;

/// A ray and where it stands: *top is what it visits next, and top[kShortStack] its key.
struct alignas(64) RayInFlight {
  KernelRay ray;
  TriangleHit hit;  // hit.t is the limit
  std::int32_t* top;
  std::uint32_t ray_index;
  std::int32_t refs[kShortStack];
  std::int32_t keys[kShortStack];

  const KernelRay& leaf_ray() const { return ray; }
  float leaf_limit() const { return hit.t; }
};

/// A block whose planes are still to be tested, and then what the test says.
template <class RayState>
struct OpenBlock {
  RayState* ray;
  const char* block;
  Crossed crossed;
  std::uint32_t lanes;
  alignas(16) float ts[kBlockWidth];
};

/// Tests the leaves that the rays of a list stand before, and calls take(open) with the blocks of which some
/// lanes are crossed. There is room for `open` blocks of all rays, and one more.
template <class Layout, class RayState, class PoolOf, class Take>
HWY_INLINE void visit_leaves(RayState* const* begin, RayState* const* end, OpenBlock<RayState>* open,
                             const PoolOf& pool_of, const Take& take) {
  // The edges first, and without a branch on what they say.
  OpenBlock<RayState>* last = open;
  for (RayState* const* i = begin; i != end; ++i) {
    RayState* ray = *i;
    const auto ref = static_cast<std::uint32_t>(*ray->top);
    const char* block = blocks_at(pool_of(*ray), ref);
    for (std::uint32_t left = ref >> 2 & 3; left > 0; --left, block += Layout::kBlockBytes) {
      last->ray = ray;
      last->block = block;
      last->crossed = test_edges(Layout::block(block), ray->leaf_ray()).crossed;
      last += last->crossed.maybe != 0;
    }
  }

  // The planes of what is left.
  for (OpenBlock<RayState>* o = open; o != last; ++o)
    o->lanes =
        test_planes(Layout::block(o->block), o->ray->leaf_ray(), o->crossed, o->ray->leaf_limit(), o->ts);

  // Only then what follows from it, which is hard to foresee.
  for (OpenBlock<RayState>* o = open; o != last; ++o)
    if (o->lanes != 0) take(*o);
}

/// Keeps of a part of a stack, whose keys lie kStack behind, what may still matter up to `limit`; returns its
/// end.
template <int kStack>
HWY_INLINE std::int32_t* cull(std::int32_t* to, const std::int32_t* end, float limit) {
  const DIW di;
  const VIW last = hn::Set(di, std::bit_cast<std::int32_t>(limit) | kChildBits);
  for (const std::int32_t* from = to; from < end; from += kWidth) {
    const VIW keys = hn::LoadU(di, from + kStack), refs = hn::LoadU(di, from);
    const auto keep =
        hn::And(hn::Not(hn::Gt(keys, last)), hn::FirstN(di, static_cast<std::size_t>(end - from)));
    hn::StoreU(compress(di, keys, keep), di, to + kStack);
    hn::StoreU(compress(di, refs, keep), di, to);
    to += hn::CountTrue(di, keep);
  }
  return to;
}

/// What is asked about a ray: its closest crossing, whether there is any, or all.
enum class Ask { closest, any, all };

/// Hands output(ray index, hit) the answer of each ray; where all crossings are asked for, output.see(ray
/// index, crossing) each of them before.
template <class Layout, Ask kAsk, class Output>
class Interleaved {
 public:
  /// Traces rays[i] for each i of `order`.
  Interleaved(const TriangleTree& tree, const Box3& bounds, const Ray* rays,
              std::span<const std::uint32_t> order, Output& output, std::vector<std::uint32_t>& unusual)
      : pool_(tree.pool()),
        box_slack_(tree.box_slack()),
        bounds_(bounds),
        rays_(rays),
        order_(order),
        output_(output),
        unusual_(unusual) {}

  void run(RayInFlight* flight) {
    const char* const pool = pool_;  // a member would be loaded anew after each store
    List nodes{lists_[kNode]}, leaves{lists_[kLeaf]}, done{lists_[kDone]};
    for (int i = 0; i < kInFlight; ++i)
      if (start(flight[i])) *nodes.end++ = flight + i;

    while (true) {
      // One step for every ray that stands before a node.
      RayInFlight **i = lists_[kNode], **end = nodes.end;
      nodes.end = lists_[kNode];
      for (; i != end; ++i) {
        RayInFlight& ray = **i;
        append(pool, ray, step(pool, ray), nodes, leaves, done);
      }
      if (nodes.end - lists_[kNode] > kFewNodes) continue;

      // Enough rays stand before a leaf: test, take it off the stack, and see where each goes next.
      visit_leaves<Layout>(
          lists_[kLeaf], leaves.end, open_, [pool](const RayInFlight&) { return pool; },
          [this](const OpenBlock<RayInFlight>& open) { take(open); });
      i = lists_[kLeaf], end = leaves.end;
      leaves.end = lists_[kLeaf];
      for (; i != end; ++i) {
        RayInFlight& ray = **i;
        append(pool, ray, ray.top - 1, nodes, leaves, done);
      }

      // Hand out the answers of rays that are done, and start others in their place.
      i = lists_[kDone], end = done.end;
      done.end = lists_[kDone];
      for (; i != end; ++i) {
        RayInFlight* ray = *i;
        output_(ray->ray_index, ray->hit);
        if (start(*ray)) *nodes.end++ = ray;
      }
      if (nodes.end == lists_[kNode] && leaves.end == lists_[kLeaf]) return;
    }
  }

 private:
  enum Kind { kNode = 0, kLeaf = 1, kDone = 2 };  // the low bits of a reference
  struct List {
    RayInFlight** end;
  };

  /// Prefetches what is on top of the stack, and puts the ray on the list where it belongs: without a branch,
  /// on all three, of which one grows.
  HWY_INLINE void append(const char* pool, RayInFlight& ray, std::int32_t* top, List& nodes, List& leaves,
                         List& done) {
    ray.top = top;
    const auto next = static_cast<std::uint32_t>(*top);
    prefetch_lines<Layout::kNodeLines>(node_at(pool, next));
    *nodes.end = *leaves.end = *done.end = &ray;
    const std::uint32_t kind = next & 3;
    done.end += kind >> 1;
    leaves.end += kind & 1;
    nodes.end += kind == 0;
  }

  /// Gives the place to the next ray that is ordinary; false when there is none left.
  HWY_INLINE bool start(RayInFlight& place) {
    while (next_ < order_.size()) {
      const std::uint32_t i = order_[next_++];
      __builtin_prefetch(&rays_[i] + 8);  // neighbours in the order are mostly neighbours in memory
      if (HWY_UNLIKELY(!prepare(rays_[i], bounds_, box_slack_, place.ray))) {
        unusual_.push_back(i);
        continue;
      }
      place.hit.t = rays_[i].t_max + 0.0f;
      place.hit.key = place.hit.block = TriangleHit::kNone;
      place.ray_index = i;
      place.refs[0] = static_cast<std::int32_t>(kBottom);
      place.keys[0] = 0;
      place.refs[1] = 0;
      place.top = place.refs + 1;
      return true;
    }
    return false;
  }

  /// Puts the children that the ray enters in the place of the node on top.
  HWY_INLINE std::int32_t* step(const char* pool, RayInFlight& ray) {
    const DIW di;
    std::int32_t* top = ray.top;
    const char* node = node_at(pool, static_cast<std::uint32_t>(*top));
    const Slabs slabs = BoxRay<false>(ray.ray).template cross<Layout>(node, ray.hit.t);
    const std::int32_t* children = children_of<Layout>(node);
    const std::size_t count = hn::CountTrue(di, slabs.enters);
    if constexpr (kAsk != Ask::closest) {
      hn::StoreU(compress(di, hn::Load(di, children), slabs.enters), di, top);
    } else {
      push_children(di, make_keys(slabs.entry), slabs.enters, children, count, top + kShortStack, top);
    }
    return top + count - 1;
  }

  HWY_INLINE void take(const OpenBlock<RayInFlight>& open) {
    RayInFlight& ray = *open.ray;
    const TriangleBlock& block = Layout::block(open.block);
    const std::uint32_t at = units(pool_, open.block);
    if constexpr (kAsk == Ask::any) {
      ray.hit.block = 0;
      ray.top = ray.refs + 1;  // nothing else matters: the bottom is next
    } else if constexpr (kAsk == Ask::closest) {
      if (take_closest(block, at, open.lanes, open.ts, ray.hit))
        ray.top = cull<kShortStack>(ray.refs + 1, ray.top, ray.hit.t);
    } else {
      for (std::uint32_t lanes = open.lanes; lanes; lanes &= lanes - 1) {
        const auto lane = static_cast<std::uint32_t>(__builtin_ctz(lanes));
        if (!is_padding(block.key, static_cast<int>(lane)))
          output_.see(ray.ray_index, {open.ts[lane], block.key[lane], at, lane});
      }
    }
  }

  const char* pool_;
  float box_slack_;
  const Box3& bounds_;
  const Ray* rays_;
  std::span<const std::uint32_t> order_;
  Output& output_;
  std::vector<std::uint32_t>& unusual_;
  std::size_t next_ = 0;
  RayInFlight* lists_[3][kInFlight + 1];
  OpenBlock<RayInFlight> open_[kInFlight * kMaxLeafBlocks + 1];
};

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
