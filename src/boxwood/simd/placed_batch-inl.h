// placed_batch-inl.h: many independent rays through two levels of trees, on one thread. Compiled once for
// each instruction set.
//
// As in interleave-inl.h rays take turns, and here one that comes to a placement goes on in its object's
// space: it waits on a list of its own until it is taken there, leaves a bottom on its stack, and when it is
// back at that it goes on in the world. So a ray needs no more than one stack and one line of questions,
// wherever it is: which tree, with which constants, up to which t.

#if defined(BOXWOOD_SIMD_PLACED_BATCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_PLACED_BATCH_INL_H
#undef BOXWOOD_SIMD_PLACED_BATCH_INL_H
#else
#define BOXWOOD_SIMD_PLACED_BATCH_INL_H
#endif

#include "boxwood/simd/batch-inl.h"
#include "boxwood/simd/placed-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

/// As kFewNodes; fewer, because there are three other lists to wait on.
inline constexpr int kPlacedFewNodes = 10;
/// Room for both levels; deeper trees take one ray at a time. With this much a ray takes an odd number of
/// lines of the cache, so that what is in use of many rays does not meet in few sets of it.
inline constexpr int kPlacedStack = kWidth > 8 ? 392 : 200;

/// A ray and where it stands: *top is what it visits next, and top[kPlacedStack] its key.
struct alignas(64) PlacedRay {
  KernelRay world, local;
  // Where it is: in the world, or below a placement.
  const KernelRay* ray;
  const char* pools[2];  // of nodes and leaves, and of items
  float limit;           // for boxes and triangles here
  TriangleHit hit;       // below this placement; hit.t is the world's limit
  Moved way;
  std::uint32_t item;
  std::int32_t* bottom;  // of the stack here
  std::int32_t* top;
  std::uint32_t ray_index;
  PlacedHit best;  // in what it has left behind
  std::int32_t refs[kPlacedStack];
  std::int32_t keys[kPlacedStack];

  bool is_in_world() const { return ray == &world; }
  const KernelRay& leaf_ray() const { return local; }
  float leaf_limit() const { return limit; }
};

static_assert(sizeof(PlacedRay) / kLine % 2 == 1);

template <class Layout, bool kAny, class Output>
class PlacedInterleaved {
 public:
  /// Traces rays[i] for each i of `order`, up to limit_of(i), and hands over what it finds.
  PlacedInterleaved(const PlacedTrees& trees, const Box3& bounds, const Ray* rays,
                    std::span<const std::uint32_t> order, Output& output, std::vector<std::uint32_t>& unusual)
      : world_pool_(trees.boxes().pool()),
        first_(static_cast<std::int32_t>(trees.boxes().first())),
        items_(trees.items().data()),
        bounds_(bounds),
        rays_(rays),
        order_(order),
        output_(output),
        unusual_(unusual) {}

  void run(PlacedRay* flight) {
    Ends ends{{lists_[kNode], lists_[kLeaf], lists_[kBottomRef], lists_[kItemRef]}};
    for (int i = 0; i < kInFlight; ++i) start(flight[i], ends);

    while (true) {
      // One step for every ray that stands before a node.
      PlacedRay **i = lists_[kNode], **end = ends.take(lists_, kNode);
      for (; i != end; ++i) append(**i, step(**i), ends);
      if (ends.of[kNode] - lists_[kNode] > kPlacedFewNodes) continue;

      // Enough rays stand before something else. Leaves are tested, taken off the stack, and left.
      visit_leaves<Layout>(
          lists_[kLeaf], ends.of[kLeaf], open_, [](const PlacedRay& ray) { return ray.pools[0]; },
          [this](const OpenBlock<PlacedRay>& open) { take(open); });
      i = lists_[kLeaf], end = ends.take(lists_, kLeaf);
      for (; i != end; ++i) append(**i, (*i)->top - 1, ends);

      // Placements are entered, or passed by.
      i = lists_[kItemRef], end = ends.take(lists_, kItemRef);
      for (; i != end; ++i) enter_item(**i, ends);

      // Below a placement the bottom leads back into the world, there to the end: hand out the answer and
      // start another ray in its place.
      i = lists_[kBottomRef], end = ends.take(lists_, kBottomRef);
      for (; i != end; ++i) {
        PlacedRay& ray = **i;
        if (ray.is_in_world()) {
          output_(ray.ray_index, ray.best);
          start(ray, ends);
        } else {
          leave_item(ray, ends);
        }
      }
      if (ends.of[kNode] == lists_[kNode] && ends.of[kLeaf] == lists_[kLeaf] &&
          ends.of[kItemRef] == lists_[kItemRef] && ends.of[kBottomRef] == lists_[kBottomRef])
        return;
    }
  }

 private:
  enum Kind { kNode = 0, kLeaf = 1, kBottomRef = 2, kItemRef = 3 };  // the low bits of a reference
  static_assert(kBottomRef == kBottom && kItemRef == BoxTree::kItem);
  /// An item takes this many times two more bytes than a unit of references.
  static constexpr int kItemShift = 2;
  static_assert(sizeof(PlacedTree) == TriangleTree::kUnit << kItemShift);
  using Lists = PlacedRay* [4][kInFlight + 1];
  struct Ends {
    PlacedRay** of[4];
    /// The end of a list, which is empty from now on.
    HWY_INLINE PlacedRay** take(Lists& lists, Kind kind) {
      PlacedRay** const end = of[kind];
      of[kind] = lists[kind];
      return end;
    }
  };

  /// Prefetches what is on top of the stack, and puts the ray on the list where it belongs: without a branch,
  /// on all of them, of which one grows.
  HWY_INLINE void append(PlacedRay& ray, std::int32_t* top, Ends& ends) {
    ray.top = top;
    const auto next = static_cast<std::uint32_t>(*top);
    const std::uint32_t low = next & 1, high = next >> 1 & 1, is_item = low & high;
    prefetch_lines<Layout::kNodeLines>(ray.pools[is_item] +
                                       (std::size_t(next & ~15u) << (1 + kItemShift * is_item)));
    for (PlacedRay** end_of : ends.of) *end_of = &ray;
    ends.of[kNode] += (low | high) ^ 1;
    ends.of[kLeaf] += low & ~high;
    ends.of[kBottomRef] += high & ~low;
    ends.of[kItemRef] += is_item;
  }

  /// Gives the place to the next ray that is ordinary, if there is one.
  HWY_INLINE void start(PlacedRay& place, Ends& ends) {
    while (next_ < order_.size()) {
      const std::uint32_t i = order_[next_++];
      __builtin_prefetch(&rays_[i] + 8);  // neighbours in the order are mostly neighbours in memory
      if (HWY_UNLIKELY(!prepare(rays_[i], bounds_, BoxTree::kSlack, place.world))) {
        unusual_.push_back(i);
        continue;
      }
      place.best = output_.before(i);
      place.ray = &place.world;
      place.pools[0] = world_pool_;
      place.pools[1] = reinterpret_cast<const char*>(items_);
      place.limit = place.hit.t = place.best.t;
      place.ray_index = i;
      place.refs[0] = static_cast<std::int32_t>(kBottom);
      place.keys[0] = 0;
      place.refs[1] = first_;
      place.bottom = place.refs;
      append(place, place.refs + 1, ends);
      return;
    }
  }

  /// Puts the children that the ray enters in the place of the node on top.
  HWY_INLINE std::int32_t* step(PlacedRay& ray) {
    if constexpr (!std::is_same_v<Layout, FullLayout>)
      if (ray.is_in_world()) return step_in<FullLayout>(ray);  // boxes of placements are kept in full
    return step_in<Layout>(ray);
  }
  template <class NodeLayout>
  HWY_INLINE std::int32_t* step_in(PlacedRay& ray) {
    const DIW di;
    std::int32_t* top = ray.top;
    const char* node = node_at(ray.pools[0], static_cast<std::uint32_t>(*top));
    const Slabs slabs = BoxRay<true>(*ray.ray).template cross<NodeLayout>(node, ray.limit);
    const std::int32_t* children = children_of<NodeLayout>(node);
    const std::size_t count = hn::CountTrue(di, slabs.enters);
    if constexpr (kAny)
      hn::StoreU(compress(di, hn::Load(di, children), slabs.enters), di, top);
    else
      push_children(di, make_keys(slabs.entry), slabs.enters, children, count, top + kPlacedStack, top);
    return top + count - 1;
  }

  HWY_INLINE void take(const OpenBlock<PlacedRay>& open) {
    PlacedRay& ray = *open.ray;
    const TriangleBlock& block = Layout::block(open.block);
    if (!take_closest(block, units(ray.pools[0], open.block), open.lanes, open.ts, ray.hit, ray.way)) return;
    if constexpr (kAny) {
      ray.top = ray.bottom + 1;  // nothing else matters: the bottom is next
    } else {
      ray.limit = ray.way.limit(ray.hit.t);
      ray.top = cull<kPlacedStack>(ray.bottom + 1, ray.top, ray.limit);
    }
  }

  /// Takes the ray below the placement on top of its stack.
  HWY_INLINE void enter_item(PlacedRay& ray, Ends& ends) {
    const std::uint32_t item = BoxTree::item_of(static_cast<std::uint32_t>(*ray.top));
    const PlacedTree& placed = items_[item];
    const Entry entry = enter(placed, rays_[ray.ray_index], ray.world, ray.best.t, ray.local, ray.way);
    if (entry == Entry::passes_by) {
      append(ray, ray.top - 1, ends);
      return;
    }
    if (HWY_UNLIKELY(entry == Entry::is_unusual)) {
      unusual_.push_back(ray.ray_index);
      start(ray, ends);
      return;
    }
    ray.ray = &ray.local;
    ray.pools[0] = placed.pool;
    ray.item = item;
    ray.hit = {ray.best.t, tie_key(placed, ray.best.instance)};
    ray.limit = ray.way.limit(ray.best.t);
    ray.bottom = ray.top;
    ray.bottom[0] = static_cast<std::int32_t>(kBottom);
    ray.top[1] = 0;
    append(ray, ray.top + 1, ends);
  }

  /// Takes it back into the world.
  HWY_INLINE void leave_item(PlacedRay& ray, Ends& ends) {
    std::int32_t* top = ray.bottom;
    if (ray.hit.is_hit()) {
      ray.best = {ray.hit, ray.item, items_[ray.item].instance};
      top = kAny ? ray.refs + 1 : cull<kPlacedStack>(ray.refs + 1, top, ray.best.t);
    }
    ray.ray = &ray.world;
    ray.pools[0] = world_pool_;
    ray.limit = ray.best.t;
    ray.bottom = ray.refs;
    append(ray, top - 1, ends);
  }

  const char* world_pool_;
  std::int32_t first_;
  const PlacedTree* items_;
  const Box3& bounds_;
  const Ray* rays_;
  std::span<const std::uint32_t> order_;
  Output& output_;
  std::vector<std::uint32_t>& unusual_;
  std::size_t next_ = 0;
  Lists lists_;
  OpenBlock<PlacedRay> open_[kInFlight * kMaxLeafBlocks + 1];
};

/// found[i] is what is to be beaten, and becomes what is hit; its t the limit.
struct ClosestPlaced {
  PlacedHit* found;
  const Hit* answers;
  HWY_INLINE const PlacedHit& before(std::uint32_t i) const { return found[i]; }
  HWY_INLINE void operator()(std::uint32_t i, const PlacedHit& hit) const {
    found[i] = hit;
    fetch_answer(answers, i);
  }
};
struct AnyPlaced {
  const Ray* rays;
  bool* found;
  HWY_INLINE PlacedHit before(std::uint32_t i) const { return {{rays[i].t_max + 0.0f}}; }
  HWY_INLINE void operator()(std::uint32_t i, const PlacedHit& hit) const { found[i] = hit.is_placed(); }
};

/// Traces rays[i] for each i of `order`.
template <class Layout, bool kAny, class Output>
void trace_placed(const PlacedTrees& trees, const Box3& bounds, const Ray* rays,
                  std::span<const std::uint32_t> order, Output output, std::vector<std::uint32_t>& unusual) {
  if (trees.max_stack() + kWidth <= kPlacedStack) {
    static thread_local const std::unique_ptr<PlacedRay[]> flight(new PlacedRay[kInFlight]);
    PlacedInterleaved<Layout, kAny, Output>(trees, bounds, rays, order, output, unusual).run(flight.get());
    return;
  }
  for (const std::uint32_t i : order) {
    KernelRay world;
    if (!prepare(rays[i], bounds, BoxTree::kSlack, world)) {
      unusual.push_back(i);
      continue;
    }
    PlacedHit hit = output.before(i);
    bool is_known;
    if constexpr (kAny) {
      PlacedSearch<Layout> search{trees, rays[i], world, hit.t};
      is_known = search.run();
      if (search.is_hit) hit.item = 0;
    } else {
      PlacedWalk<Layout> walk(trees, rays[i], world, hit);
      is_known = walk.run();
      hit = walk.hit;
    }
    if (is_known)
      output(i, hit);
    else
      unusual.push_back(i);
  }
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
