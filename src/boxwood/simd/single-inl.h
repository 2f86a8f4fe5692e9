// single-inl.h: one ray through a tree. Compiled once for each instruction set (kernels.cpp).

#if defined(BOXWOOD_SIMD_SINGLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_SINGLE_INL_H
#undef BOXWOOD_SIMD_SINGLE_INL_H
#else
#define BOXWOOD_SIMD_SINGLE_INL_H
#endif

#include <bit>
#include <limits>

#include "boxwood/simd/block-inl.h"
#include "boxwood/simd/node-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

/// Room for what any tree leaves behind, and to store whole vectors.
inline constexpr int kStackSize = kMaxWideStack<kWidth> + kWidth;

/// The bottom of a stack: neither node nor leaf.
inline constexpr std::uint32_t kBottom = 2;

/// The first block of a leaf.
HWY_INLINE const char* blocks_at(const char* pool, std::uint32_t ref) {
  return pool + std::size_t(ref & ~15u) * 2;
}

/// How t is moved on its way from the tree to the answer: not at all in the world, and below a placement as
/// BoxGate (shape/gate.h) does it.
struct Direct {
  static constexpr bool kSigned = false;
  float limit(float outer) const { return outer; }
  float move(float t) const { return t; }
  bool admits(float) const { return true; }
};
struct Moved {
  static constexpr bool kSigned = true;
  Passage passage;
  float limit(float outer) const {
    if (outer < passage.inside.entry) return -kInfinity;
    return outer >= passage.inside.exit ? kInfinity : outer;
  }
  float move(float t) const { return min(max(t, passage.inside.entry), passage.inside.exit) + 0.0f; }
  bool admits(float t) const { return t >= passage.t_min; }
};

/// What names a block in a hit.
HWY_INLINE std::uint32_t units(const char* pool, const char* block) {
  return static_cast<std::uint32_t>(static_cast<std::size_t>(block - pool) / TriangleTree::kUnit);
}

/// Takes the crossings of `lanes` of the block at `at`, keeps the first in the order of the contract. Returns
/// whether `hit` changed.
template <class Way = Direct>
HWY_INLINE bool take_closest(const TriangleBlock& block, std::uint32_t at, std::uint32_t lanes,
                             const float* ts, TriangleHit& hit, const Way& way = {}) {
  bool changed = false;
  for (; lanes; lanes &= lanes - 1) {
    const auto lane = static_cast<std::uint32_t>(__builtin_ctz(lanes));
    const float t = way.move(ts[lane]);
    if (!way.admits(t) || t > hit.t || (t == hit.t && block.key[lane] >= hit.key)) continue;
    hit = {t, block.key[lane], at, lane};
    changed = true;
  }
  return changed;
}

/// Calls take(block, its place, edges, lanes, ts) with the crossings in each block of a leaf at a t in
/// [ray.t_min, limit()]; ends early when that returns true, and returns whether it did.
template <class Layout, class Limit, class Take>
HWY_INLINE bool visit_leaf(const char* pool, std::uint32_t ref, const KernelRay& ray, const Limit& limit,
                           const Take& take) {
  const char* p = blocks_at(pool, ref);
  for (std::uint32_t left = ref >> 2 & 3; left > 0; --left, p += Layout::kBlockBytes) {
    const TriangleBlock& block = Layout::block(p);
    const Edges edges = test_edges(block, ray);
    if (edges.crossed.maybe == 0) continue;
    HWY_ALIGN float ts[kBlockWidth];
    const std::uint32_t lanes = test_planes(block, ray, edges.crossed, limit(), ts);
    if (take(block, units(pool, p), edges, lanes, ts)) return true;
  }
  return false;
}

/// The first four lanes of a vector of children, and four lanes as such a vector.
template <class D>
HWY_INLINE hn::Vec<DI4> first_four(D, hn::Vec<D> v) {
  if constexpr (kWidth == 4)
    return v;
  else if constexpr (kWidth == 8)
    return hn::LowerHalf(DI4(), v);
  else
    return hn::LowerHalf(DI4(), hn::LowerHalf(hn::Half<D>(), v));
}
template <class D>
HWY_INLINE hn::Vec<D> as_children(D d, hn::Vec<DI4> v) {
  if constexpr (kWidth == 4)
    return v;
  else if constexpr (kWidth == 8)
    return hn::ZeroExtendVector(d, v);
  else
    return hn::ZeroExtendVector(d, hn::ZeroExtendVector(hn::Half<D>(), v));
}

/// Stores the references of the children that are entered, and their keys, the farthest first.
template <class D>
HWY_INLINE void push_children(D di, hn::Vec<D> keys, hn::Mask<D> enters, const std::int32_t* children,
                              std::size_t count, std::int32_t* stack_keys, std::int32_t* stack_refs) {
  // What is not entered becomes 0 and so sorts last. (With AVX-512 the compression sees to that.)
  if constexpr (HWY_TARGET > HWY_AVX3) keys = hn::IfThenElseZero(enters, keys);
  keys = compress(di, keys, enters);
  if (HWY_LIKELY(count <= 4)) {
    const DI4 d4;
    const hn::Vec<DI4> first = sort_descending(first_four(di, keys));
    hn::StoreU(first, d4, stack_keys);
    hn::Vec<D> lanes = as_children(di, first);
    if constexpr (kWidth == 4 || HWY_IS_DEBUG_BUILD)
      lanes = hn::And(lanes, hn::Set(di, kChildBits));  // others look at no more bits
    const hn::Vec<D> sorted = hn::TableLookupLanes(hn::Load(di, children), hn::IndicesFromVec(di, lanes));
    hn::StoreU(first_four(di, sorted), d4, stack_refs);
    return;
  }

  if constexpr (kWidth > 4) {
    if constexpr (kWidth > 8) {
      if (HWY_LIKELY(count <= 8)) {
        const hn::Half<D> d8;
        const auto first = sort_eight_descending(d8, hn::LowerHalf(d8, keys));
        hn::StoreU(first, d8, stack_keys);
        hn::Vec<D> lanes = hn::ZeroExtendVector(di, first);
        if constexpr (HWY_IS_DEBUG_BUILD) lanes = hn::And(lanes, hn::Set(di, kChildBits));
        const hn::Vec<D> sorted = hn::TableLookupLanes(hn::Load(di, children), hn::IndicesFromVec(di, lanes));
        hn::StoreU(hn::LowerHalf(d8, sorted), d8, stack_refs);
        return;
      }
    }
    const hn::Vec<D> sorted = sort_all_descending(di, keys);
    hn::StoreU(sorted, di, stack_keys);
    const auto lanes = hn::IndicesFromVec(di, hn::And(sorted, hn::Set(di, kChildBits)));
    hn::StoreU(hn::TableLookupLanes(hn::Load(di, children), lanes), di, stack_refs);
  }
}

/// Makes the compiler read what is behind the pointer anew. A ray's constants are broadcast from memory at no
/// cost; kept in registers, they would be stored before every leaf and loaded again behind it.
template <class T>
HWY_INLINE void read_anew(const T*& pointer) {
  asm volatile("" : "+r"(pointer));
}

/// The edge functions of the block that was hit last, for finish_one (finish-inl.h).
struct EdgesOfHit {
  HWY_ALIGN float wa[kBlockWidth];
  HWY_ALIGN float wb[kBlockWidth];
  HWY_ALIGN float wc[kBlockWidth];
};

/// result.t is the limit before.
template <class Layout, class Way>
HWY_NOINLINE void closest_hit_one(const char* pool, const KernelRay& ray, const Way& way, TriangleHit& result,
                                  EdgesOfHit& edges_of_hit) {
  const DIW di;
  const KernelRay* constants = &ray;
  TriangleHit hit = result;
  HWY_ALIGN std::int32_t keys[kStackSize], refs[kStackSize];
  keys[0] = std::numeric_limits<std::int32_t>::min();  // below every limit
  refs[0] = static_cast<std::int32_t>(kBottom);
  std::size_t top = 0;
  std::uint32_t current = 0;
  while (true) {
    if ((current & 3) == 0) {
      const char* node = node_at(pool, current);
      const std::int32_t* children = children_of<Layout>(node);
      // They have a line of their own, which would be asked for only when the planes are known.
      __builtin_prefetch(children);
      read_anew(constants);
      const BoxRay<Way::kSigned> box_ray(*constants);
      const Slabs slabs = box_ray.template cross<Layout>(node, way.limit(hit.t));
      const std::uint32_t bits = mask_bits(di, slabs.enters);
      if (bits != 0) {
        if ((bits & (bits - 1)) == 0) {
          current = static_cast<std::uint32_t>(children[__builtin_ctz(bits)]);
          continue;
        }
        const std::uint32_t others = bits & (bits - 1);
        if ((others & (others - 1)) == 0) {
          // Two children: sooner compared than sorted.
          HWY_ALIGN std::int32_t entry[kWidth];
          hn::Store(slabs.entry, di, entry);
          const int i = __builtin_ctz(bits), j = __builtin_ctz(others);
          const int near = entry[i] <= entry[j] ? i : j, far = i ^ j ^ near;
          prefetch_lines<Layout::kNodeLines>(node_at(pool, static_cast<std::uint32_t>(children[far])));
          ++top;
          keys[top] = entry[far];
          refs[top] = children[far];
          current = static_cast<std::uint32_t>(children[near]);
          continue;
        }
        const auto count = static_cast<std::size_t>(__builtin_popcount(bits));
        push_children(di, make_keys(slabs.entry), slabs.enters, children, count, keys + top + 1,
                      refs + top + 1);
        top += count - 1;
        current = static_cast<std::uint32_t>(refs[top + 1]);
        prefetch_lines<Layout::kNodeLines>(node_at(pool, static_cast<std::uint32_t>(refs[top])));
        continue;
      }
    } else {
      if (current == kBottom) break;
      visit_leaf<Layout>(
          pool, current, ray, [&] { return way.limit(hit.t); },
          [&](const TriangleBlock& block, std::uint32_t at, const Edges& edges, std::uint32_t lanes,
              const float* ts) {
            // Mostly one triangle is crossed, and which one the edges have said: what is worked out of it
            // need not wait for the plane.
            const std::uint32_t maybe = edges.crossed.maybe;
            if (HWY_LIKELY((maybe & (maybe - 1)) == 0)) {
              if (lanes == 0) return false;
              lanes = maybe;
            }
            if (take_closest(block, at, lanes, ts, hit, way)) {
              hn::Store(edges.wa, D4(), edges_of_hit.wa);
              hn::Store(edges.wb, D4(), edges_of_hit.wb);
              hn::Store(edges.wc, D4(), edges_of_hit.wc);
            }
            return false;
          });
    }
    const std::int32_t limit_key = std::bit_cast<std::int32_t>(way.limit(hit.t)) | kChildBits;
    while (keys[top] > limit_key) --top;
    current = static_cast<std::uint32_t>(refs[top]);
    --top;
  }
  result = hit;
}

/// Room for a walk that takes two nodes at a time. What is on top of its stack lies deepest in the tree, so
/// of each level there are at most the children of two nodes, less the two that were taken.
inline constexpr int kTwoStacks = 2 * kMaxWideStack<kWidth> + kWidth;

/// Calls see(leaf) with the leaves that the ray enters before `limit`, in no order, until it returns true;
/// returns whether it did. Where no order is asked for, two nodes need not wait for each other.
template <class Layout, bool kSigned, class See>
HWY_INLINE bool enter_leaves(const char* pool, const KernelRay& ray, float limit, const See& see) {
  const DIW di;
  const BoxRay<kSigned> box_ray(ray);
  HWY_ALIGN std::int32_t nodes[kTwoStacks], leaves[3 * kWidth];
  std::size_t node_count = 1, leaf_count = 0;
  nodes[0] = 0;
  while (node_count > 0) {
    // Where there is one node only, nothing is entered of the other.
    const bool are_two = node_count > 1;
    const char* first = node_at(pool, static_cast<std::uint32_t>(nodes[node_count - 1]));
    const char* second = node_at(pool, static_cast<std::uint32_t>(nodes[are_two ? node_count - 2 : 0]));
    node_count -= 1 + are_two;
    const auto first_enters = box_ray.template cross<Layout>(first, limit).enters;
    const auto second_enters = box_ray.template cross<Layout>(second, are_two ? limit : -kInfinity).enters;
    const auto push = [&](const char* node, hn::Mask<DIW> enters) {
      const VIW children = hn::Load(di, children_of<Layout>(node));
      const auto is_leaf = hn::TestBit(children, hn::Set(di, 1));
      const auto is_entered_node = hn::AndNot(is_leaf, enters), is_entered_leaf = hn::And(is_leaf, enters);
      hn::StoreU(compress(di, children, is_entered_node), di, nodes + node_count);
      hn::StoreU(compress(di, children, is_entered_leaf), di, leaves + leaf_count);
      node_count += hn::CountTrue(di, is_entered_node);
      leaf_count += hn::CountTrue(di, is_entered_leaf);
    };
    push(second, second_enters);
    push(first, first_enters);

    while (leaf_count > 0)
      if (see(static_cast<std::uint32_t>(leaves[--leaf_count]))) return true;
  }
  return false;
}

/// Not inlined, nor is the next: where a ray's constants are put together the compiler would take them apart
/// again, at each node anew.
template <class Layout, class Way>
HWY_NOINLINE bool any_hit_one(const char* pool, const KernelRay& ray, const Way& way, float t_max) {
  const float limit = way.limit(t_max);
  return enter_leaves<Layout, Way::kSigned>(pool, ray, limit, [&](std::uint32_t leaf) {
    return visit_leaf<Layout>(
        pool, leaf, ray, [&] { return limit; },
        [&](const TriangleBlock&, std::uint32_t, const Edges&, std::uint32_t lanes, const float* ts) {
          for (; lanes; lanes &= lanes - 1)
            if (way.admits(way.move(ts[__builtin_ctz(lanes)]))) return true;
          return false;
        });
  });
}

template <class Layout, class Way>
HWY_NOINLINE void all_hits_one(const char* pool, const KernelRay& ray, const Way& way, float t_max,
                               std::vector<TriangleHit>& hits) {
  const float limit = way.limit(t_max);
  enter_leaves<Layout, Way::kSigned>(pool, ray, limit, [&](std::uint32_t leaf) {
    return visit_leaf<Layout>(
        pool, leaf, ray, [&] { return limit; },
        [&](const TriangleBlock& block, std::uint32_t at, const Edges&, std::uint32_t lanes,
            const float* ts) {
          for (; lanes; lanes &= lanes - 1) {
            const auto lane = static_cast<std::uint32_t>(__builtin_ctz(lanes));
            if (is_padding(block.key, static_cast<int>(lane))) continue;
            const float t = way.move(ts[lane]);
            if (way.admits(t)) hits.push_back({t, block.key[lane], at, lane});
          }
          return false;
        });
  });
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
