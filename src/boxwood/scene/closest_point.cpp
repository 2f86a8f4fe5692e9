// closest_point.cpp: which point of a scene is nearest?
//
// A kernel (simd/kernels.h) finds the nearest of the world's triangles. The rest is the walk of traverse.h
// with a distance in place of a t: boxes of placed objects are taken into the world one by one, and the
// distance to a primitive is never reported below that of its own box: the law of gate.h, for distances.
// Many points are answered along a Z-shaped curve, so that each begins with what the one before was nearest
// to, and most boxes are too far from the start.
#include <algorithm>
#include <stdexcept>

#include "boxwood/core/morton.h"
#include "boxwood/query/distance.h"
#include "boxwood/scene/batch.h"
#include "boxwood/scene/stream.h"
#include "boxwood/scene/walk.h"

namespace boxwood {
namespace {

struct Best {
  float limit;  // the distance
  bool found = false;
  Vec3 position;
  InstanceId instance_id;
  PrimId primitive_id;

  void consider(float distance_found, Vec3 p, InstanceId instance, PrimId primitive) {
    if (!(distance_found <= limit)) return;
    if (found && distance_found == limit &&
        (instance != instance_id ? instance > instance_id : primitive >= primitive_id))
      return;
    limit = distance_found;
    found = true;
    position = p;
    instance_id = instance;
    primitive_id = primitive;
  }
};

/// How one space sees the point: the world itself, or an object under a placement (null: the world).
struct View {
  Vec3 point;
  const Placement* placement;

  Box3 to_world(const Box3& box) const {
    return placement ? transform_box(placement->world_from_object, box) : box;
  }
  Vec3 to_world(Vec3 p) const { return placement ? placement->world_from_object.point(p) : p; }
  Triangle to_world(const Triangle& t) const { return {to_world(t.a), to_world(t.b), to_world(t.c)}; }

  Vec3 nearest(const Triangle& triangle) const { return to_world(triangle).closest_point(point); }
  Vec3 nearest(const Quad& quad) const {
    return Quad{to_world(quad.a), to_world(quad.b), to_world(quad.c), to_world(quad.d)}.closest_point(point);
  }
  template <class S>
  Vec3 nearest(const S& shape) const {  // under a similarity the nearest point is the same in both spaces
    return placement ? to_world(shape.closest_point(placement->object_from_world.point(point)))
                     : shape.closest_point(point);
  }
};

/// What the queries for triangles and for other shapes share.
struct PointQuery {
  const View& view;
  Best& best;

  /// Of the whole of a primitive, or of a box around wholes.
  float bound(const Box3& box) const { return distance(view.to_world(box), view.point); }
  float limit() const { return best.limit; }
  template <class S>
  void meet(const S& shape, InstanceId own_instance, PrimId primitive) {
    if (shape.box().is_empty()) return;
    const Vec3 p = view.nearest(shape);
    const float found = max(distance(p, view.point), bound(shape.box()));
    best.consider(found, p, view.placement ? view.placement->instance_id : own_instance, primitive);
  }
};

/// How far the nearest point of a triangle may be outside the part that it belongs to, after rounding: of the
/// corners on their way into the world, and of the point itself.
float rounding_of_points(const View& view, const Part& part) {
  Vec3 reach = max(abs(part.bounds.lower), abs(part.bounds.upper));
  if (view.placement) {
    const Affine3& m = view.placement->world_from_object;
    reach = abs(m.x) * reach.x + abs(m.y) * reach.y + abs(m.z) * reach.z + abs(m.origin);
  }
  return max_component(reach) * 0x1p-20f;
}

struct TrianglePointQuery : PointQuery {
  const Part& part;
  float slack;  ///< For boxes of parts.

  /// The law of gate.h holds for the box of a whole triangle; that of a part is taken as a little nearer.
  float bound(const Box3& box) const {
    const float least = PointQuery::bound(box);
    return part.triangles.has_parts() ? least * (1 - 0x1p-20f) - slack : least;
  }
  void visit(ChildRef leaf) {
    for (std::uint32_t i = 0; i < leaf.blocks(); ++i) {
      const simd::TriangleBlock block = part.triangles.block_of(leaf, i);
      for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
        if (is_padding(block.key, static_cast<int>(lane))) continue;
        const PartMesh& mesh = part.mesh_of(block.key[lane]);
        meet(block.triangle(lane), mesh.instance_id, PrimId(block.key[lane] - mesh.first_key));
      }
    }
  }
};

struct ShapePointQuery : PointQuery {
  const SceneDesc& desc;
  const Part& part;
  void visit(PrimId id) {
    const LeafShape& item = part.shapes[id.value];
    with_shape(desc.geometries[item.geometry_id.value], item.primitive_id,
               [&](const auto& shape) { meet(shape, item.instance_id, item.primitive_id); });
  }
};

void search_triangles(const Part& part, const View& view, Best& best) {
  NoStatistics none;
  TrianglePointQuery triangles{{view, best}, part, rounding_of_points(view, part)};
  detail::traverse_triangles(part.triangles, triangles, none);
}

void search_shapes(const Scene::Parts& parts, const Part& part, const View& view, Best& best) {
  ShapePointQuery shapes{{view, best}, parts.desc, part};
  traverse(part.shape_bvh, shapes);
}

struct PlacementPointQuery {
  const Scene::Parts& parts;
  Vec3 point;
  Best& best;
  float bound(const Box3& box) const { return distance(box, point); }
  float limit() const { return best.limit; }
  void visit(PrimId id) {
    const Placement& placement = parts.placements[id.value];
    const Part& object = parts.objects[placement.part_index];
    const View view{point, &placement};
    search_triangles(object, view, best);
    search_shapes(parts, object, view, best);
  }
};

void check_answerable(const Scene::Parts& parts) {
  if (!parts.closest_point_obstacle.empty())
    throw std::invalid_argument("closest_point: the scene cannot answer, " + parts.closest_point_obstacle);
}

/// Begins to look at the triangles of `block`; leaves there where the nearest triangle stands, if any is.
ScenePoint find_point(const Scene::Parts& parts, Vec3 point, float max_distance, std::uint32_t& block) {
  if (!is_finite(point) || !(max_distance >= 0)) return {};

  // The world's triangles.
  Best best{max_distance, false, {}, {}, {}};
  simd::TrianglePoint nearest;
  nearest.block = block;
  const View world{point, nullptr};
  if (!parts.world.triangles.is_empty() && parts.kernels &&
      parts.kernels->closest_point(parts.world.triangles, point, max_distance, nearest)) {
    if (nearest.is_found()) {
      block = nearest.block;
      const PartMesh& mesh = parts.world.mesh_of(nearest.key);
      best = {nearest.distance, true, nearest.position, mesh.instance_id,
              PrimId(nearest.key - mesh.first_key)};
    }
  } else {
    search_triangles(parts.world, world, best);
  }

  // Everything else.
  if (!parts.is_only_triangles) {
    search_shapes(parts, parts.world, world, best);
    PlacementPointQuery placements{parts, point, best};
    traverse(parts.top_level, placements);
  }
  if (!best.found) return {};
  return {best.limit, best.position, best.instance_id, parts.instances[best.instance_id.value].geometry,
          best.primitive_id};
}

}  // namespace

ScenePoint Scene::closest_point(Vec3 point, float max_distance) const {
  check_answerable(*parts_);
  std::uint32_t block = simd::TrianglePoint::kNone;
  return find_point(*parts_, point, max_distance, block);
}

void detail::answer_closest_points(const Scene::Parts& parts, std::span<const SearchPoint> points,
                                   ScenePoint* found) {
  check_answerable(parts);
  // The place of each point in the chunk, below its code.
  constexpr int kPlaceBits = 12;
  static_assert(kMaxChunk <= 1 << kPlaceBits);
  std::uint64_t order[kMaxChunk];
  for (std::size_t i = 0; i < points.size(); ++i)
    order[i] = std::uint64_t(morton30(points[i].point, parts.bounds)) << kPlaceBits | i;
  std::sort(order, order + points.size());

  std::uint32_t block = simd::TrianglePoint::kNone;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t i = order[k] & ((1u << kPlaceBits) - 1);
    found[i] = find_point(parts, points[i].point, points[i].max_distance, block);
  }
}

}  // namespace boxwood
