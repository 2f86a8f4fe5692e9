// placed-inl.h: how does a ray go from the world into the space of what is placed there? One ray through both
// levels. Compiled once for each instruction set (kernels.cpp).

#if defined(BOXWOOD_SIMD_PLACED_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_PLACED_INL_H
#undef BOXWOOD_SIMD_PLACED_INL_H
#else
#define BOXWOOD_SIMD_PLACED_INL_H
#endif

#include "boxwood/simd/boxes-inl.h"
#include "boxwood/simd/placed_trees.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

/// The smallest lane, in all of them.
HWY_INLINE V4 smallest(V4 v) {
  v = hn::Min(v, hn::Shuffle2301(v));
  return hn::Min(v, hn::Shuffle1032(v));
}

/// PreparedRay::interval (core/prepared_ray.h), with the same operations and so the same bits.
HWY_INLINE Interval interval_inside(const Box3& box, const Ray& ray, const KernelRay& constants) {
  const D4 d;
  const V4 lower = hn::LoadU(d, &box.lower.x), upper = hn::Shuffle0321(hn::LoadU(d, &box.lower.z));
  const V4 direction = hn::LoadU(d, &ray.direction.x), r = hn::Load(d, constants.inverse);
  const V4 near = hn::IfNegativeThenElse(direction, upper, lower),
           far = hn::IfNegativeThenElse(direction, lower, upper);
  const V4 entry = hn::Add(hn::Mul(near, r), hn::Load(d, constants.gate_near_shift));
  const V4 exit = hn::Add(hn::Mul(far, r), hn::Load(d, constants.gate_far_shift));
  const auto is_axis = hn::FirstN(d, 3);
  return {hn::GetLane(largest(hn::IfThenElse(is_axis, entry, hn::Set(d, -kInfinity)))),
          hn::GetLane(smallest(hn::IfThenElse(is_axis, exit, hn::Set(d, kInfinity))))};
}

/// Affine3::point and Affine3::vector, with the same operations. Reads, and ignores, the float behind the
/// map: one that stands in a PlacedTree has it.
HWY_INLINE Ray in_object_space(const Affine3& object_from_world, const Ray& ray, float t_min) {
  const D4 d;
  const V4 x = hn::LoadU(d, &object_from_world.x.x), y = hn::LoadU(d, &object_from_world.y.x),
           z = hn::LoadU(d, &object_from_world.z.x), at = hn::LoadU(d, &object_from_world.origin.x);
  const auto sum = [&](Vec3 v) {
    return hn::Add(hn::Add(hn::Mul(x, hn::Set(d, v.x)), hn::Mul(y, hn::Set(d, v.y))),
                   hn::Mul(z, hn::Set(d, v.z)));
  };
  // Both halves are stored whole, as they are loaded again: a load of what two stores wrote would wait.
  const auto is_axis = hn::FirstN(d, 3);
  Ray local;
  hn::StoreU(hn::IfThenElse(is_axis, hn::Add(sum(ray.origin), at), hn::Set(d, t_min)), d, &local.origin.x);
  hn::StoreU(hn::IfThenElse(is_axis, sum(ray.direction), hn::Set(d, kInfinity)), d, &local.direction.x);
  return local;
}

enum class Entry { passes_by, enters, is_unusual };

/// Takes the ray below a placement, unless nothing there can be hit at a t up to `limit`, the world's. A ray
/// that is not ordinary there is unusual.
HWY_INLINE Entry enter(const PlacedTree& placed, const Ray& ray, const KernelRay& world, float limit,
                       KernelRay& local, Moved& way) {
  way.passage = {interval_inside(placed.world_box, ray, world), world.t_min};
  const Interval& inside = way.passage.inside;
  if (inside.is_empty() || limit < inside.entry || !placed.tree) return Entry::passes_by;
  // As inner_t_min() in shape/gate.h says.
  const float t_min = inside.entry >= world.t_min ? -kInfinity : world.t_min;
  const Ray object_ray = in_object_space(placed.object_from_world, ray, t_min);
  return prepare<true>(object_ray, placed.bounds, placed.box_slack, local) ? Entry::enters
                                                                           : Entry::is_unusual;
}

/// The key from which on an equal t below the placement does not count, when what has been hit before has the
/// instance `before`.
HWY_INLINE std::uint32_t tie_key(const PlacedTree& placed, std::uint32_t before) {
  return placed.instance < before ? TriangleHit::kNone : 0;
}

/// One ray on its way through both levels, closest hit.
template <class Layout>
struct PlacedWalk {
  const PlacedTrees& trees;
  const Ray& ray;
  const KernelRay& world;
  PlacedHit hit;  // hit.t is the limit
  KernelRay local[2];
  EdgesOfHit edges[2];
  int winner = 0;  // which of both belong to the hit
  bool is_unusual = false;

  /// Written out: what is not named in braces would be set to 0, half a kilobyte for each ray.
  HWY_INLINE PlacedWalk(const PlacedTrees& trees, const Ray& ray, const KernelRay& world,
                        const PlacedHit& hit)
      : trees(trees), ray(ray), world(world), hit(hit) {}

  /// False when the answer is not known.
  HWY_INLINE bool run() {
    visit_boxes_one(trees.boxes().pool(), trees.boxes().first(), world, hit.t, *this);
    return !is_unusual;
  }

  HWY_INLINE float visit(std::uint32_t item) {
    const PlacedTree& placed = trees.items()[item];
    Moved way;
    KernelRay& below = local[winner ^ 1];
    const Entry entry = enter(placed, ray, world, hit.t, below, way);
    if (entry == Entry::enters) {
      TriangleHit found{hit.t, tie_key(placed, hit.instance)};
      closest_hit_one<Layout>(placed.pool, below, way, found, edges[winner ^ 1]);
      if (found.is_hit()) {
        hit = {found, item, placed.instance};
        winner ^= 1;
      }
    } else if (entry == Entry::is_unusual) {
      is_unusual = true;
    }
    return is_unusual ? -kInfinity : hit.t;
  }
};

/// Whether anything below a placement is hit.
template <class Layout>
struct PlacedSearch {
  const PlacedTrees& trees;
  const Ray& ray;
  const KernelRay& world;
  float limit;
  bool is_hit = false, is_unusual = false;

  /// False when the answer is not known.
  HWY_INLINE bool run() {
    visit_boxes_one(trees.boxes().pool(), trees.boxes().first(), world, limit, *this);
    return !is_unusual;
  }

  HWY_INLINE float visit(std::uint32_t item) {
    const PlacedTree& placed = trees.items()[item];
    Moved way;
    KernelRay local;
    const Entry entry = enter(placed, ray, world, limit, local, way);
    if (entry == Entry::enters)
      is_hit = any_hit_one<Layout>(placed.pool, local, way, limit);
    else
      is_unusual = entry == Entry::is_unusual;
    return is_hit || is_unusual ? -kInfinity : limit;
  }
};

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
