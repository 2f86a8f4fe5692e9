// placed_finish-inl.h: where on its triangle does each hit below a placement lie, and how does that triangle
// lie in the world? Compiled once for each instruction set (kernels.cpp).
//
// As in finish-inl.h, with the ray taken into the object's space again and the normal brought back: a whole
// vector of hits at a time, with the operations of core/affine.h and so the same bits.

#if defined(BOXWOOD_SIMD_PLACED_FINISH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_PLACED_FINISH_INL_H
#undef BOXWOOD_SIMD_PLACED_FINISH_INL_H
#else
#define BOXWOOD_SIMD_PLACED_FINISH_INL_H
#endif

#include "boxwood/simd/finish-inl.h"
#include "boxwood/simd/placed-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

/// normalize(transform_normal(object_from_world, normal)) of one.
inline Vec3 normal_in_world(const Affine3& object_from_world, Vec3 normal) {
  return normalize(transform_normal(object_from_world, normal));
}

/// Works out kFinished hits, of which `count` are wanted.
template <class Layout>
HWY_INLINE void finish_placed_group(const PlacedTrees& trees, const Ray* rays, const PlacedHit* found,
                                    const std::uint32_t* ray_index, std::size_t count, Hit* hits) {
  const DF d;
  const DIF di;
  const PlacedTree* items = trees.items().data();

  // Fetch triangles one by one, for trees differ, and what a lane has at an equal distance by vectors.
  HWY_ALIGN float vertices[3][3][kFinished];
  HWY_ALIGN std::int32_t item_at[kFinished];
  for (std::size_t n = 0; n < kFinished; ++n) {
    const PlacedHit& hit = found[ray_index[n]];
    const TriangleBlock& block =
        Layout::block(items[hit.item].pool + std::size_t(hit.block) * TriangleTree::kUnit);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) vertices[i][k][n] = block.v[i][k][hit.lane];
    item_at[n] = static_cast<std::int32_t>(hit.item * (sizeof(PlacedTree) / sizeof(float)));
  }
  const VIF ray_at = hn::ShiftLeft<3>(hn::Load(di, reinterpret_cast<const std::int32_t*>(ray_index)));
  const VIF map_at = hn::Load(di, item_at);
  VF v[3][3], o[3], dir[3], map[4][3];
  const Affine3& first = items->object_from_world;
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) v[i][k] = hn::Load(d, vertices[i][k]);
    o[k] = hn::GatherIndex(d, &rays->origin.x + k, ray_at);
    dir[k] = hn::GatherIndex(d, &rays->direction.x + k, ray_at);
    map[0][k] = hn::GatherIndex(d, &first.x.x + k, map_at);
    map[1][k] = hn::GatherIndex(d, &first.y.x + k, map_at);
    map[2][k] = hn::GatherIndex(d, &first.z.x + k, map_at);
    map[3][k] = hn::GatherIndex(d, &first.origin.x + k, map_at);
  }

  // Affine3::point and Affine3::vector.
  VF origin[3], direction[3], normal[3];
  for (int k = 0; k < 3; ++k) {
    const auto sum = [&](const VF(&of)[3]) {
      return hn::Add(hn::Add(hn::Mul(map[0][k], of[0]), hn::Mul(map[1][k], of[1])),
                     hn::Mul(map[2][k], of[2]));
    };
    origin[k] = hn::Add(sum(o), map[3][k]);
    direction[k] = sum(dir);
  }
  find_normals(v, normal);
  const Weights weights = weigh(v, origin, direction);

  // transform_normal() and normalize().
  const auto dot_of = [](const VF(&a)[3], const VF(&b)[3]) {
    return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2]));
  };
  const VF moved[3] = {dot_of(map[0], normal), dot_of(map[1], normal), dot_of(map[2], normal)};
  const VF size_of_normal = hn::Sqrt(dot_of(moved, moved));
  for (int k = 0; k < 3; ++k) normal[k] = hn::Div(moved[k], size_of_normal);

  write_group(weights, normal, found, ray_index, count, hits, [&](std::uint32_t i) {
    const PlacedTree& placed = items[found[i].item];
    const Affine3& m = placed.object_from_world;
    return cross(RayShear(m.point(rays[i].origin), m.vector(rays[i].direction)),
                 placed.tree->triangle(found[i].block, found[i].lane));
  });
}

template <class Layout>
void finish_all_placed(const PlacedTrees& trees, std::span<const Ray> rays, const PlacedHit* found,
                       Hit* hits) {
  finish_listed(
      rays.size(), [&](std::size_t i) { return found[i].is_placed(); },
      [&](std::size_t i, std::uint32_t mask) {
        return trees.items()[found[i].item & mask].pool +
               std::size_t(found[i].block & mask) * TriangleTree::kUnit;
      },
      [&](const std::uint32_t* ray_index, std::size_t count) {
        finish_placed_group<Layout>(trees, rays.data(), found, ray_index, count, hits);
      });
}

/// Works out one hit, whose ray below the placement and edge functions are still at hand.
template <class Layout>
HWY_INLINE void finish_one_placed(const PlacedTrees& trees, const PlacedWalk<Layout>& walk, Hit& hit) {
  const PlacedHit& found = walk.hit;
  const PlacedTree& placed = trees.items()[found.item];
  finish_one<Layout>(*placed.tree, walk.local[walk.winner], found, walk.edges[walk.winner], hit);
  hit.normal = normal_in_world(placed.object_from_world, hit.normal);
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
