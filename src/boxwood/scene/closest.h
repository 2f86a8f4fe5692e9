// closest.h: how does what a kernel or a walk has found become an answer?
//
// A kernel names a triangle by its place in the tree and says t. The rest of a hit is worked out once, for
// the triangle that won: from the block that was just tested, not from the mesh, whose vertices would be
// three cache misses.
#pragma once

#include "boxwood/scene/walk.h"

namespace boxwood::detail {

inline Hit make_hit(const Scene::Parts& parts, const Crossing& crossing, InstanceId instance_id,
                    PrimId primitive_id) {
  Hit hit;
  hit.t = crossing.t;
  hit.u = crossing.u;
  hit.v = crossing.v;
  hit.part = crossing.part;
  hit.instance_id = instance_id;
  hit.geometry_id = parts.instances[instance_id.value].geometry;
  hit.primitive_id = primitive_id;
  return hit;
}

/// Names the triangle of the world with the key `key`.
inline void name_hit(const Part& world, std::uint32_t key, Hit& hit) {
  const PartMesh& mesh = world.mesh_of(key);
  hit.instance_id = mesh.instance_id;
  hit.geometry_id = mesh.geometry_id;
  hit.primitive_id = PrimId(key - mesh.first_key);
}

/// The hit on a triangle of the world. Precondition: found.is_hit().
inline Hit finish_triangle(const Scene::Parts& parts, const Ray& ray, const simd::TriangleHit& found) {
  const Triangle triangle = parts.world.triangles.triangle(found.block, found.lane);
  Crossing crossing;
  intersect_triangle(RayShear(ray.origin, ray.direction), triangle.a, triangle.b, triangle.c, crossing);
  Hit hit;
  hit.t = found.t;
  hit.u = crossing.u;
  hit.v = crossing.v;
  hit.normal = triangle.normal();
  name_hit(parts.world, found.key, hit);
  return hit;
}

/// Works out the normal from the description.
void fill_normal(const Scene::Parts& parts, const PreparedRay& ray, Hit& hit);

/// Has kernels find the first hit on a triangle, in the world and below placements; false when they do not
/// take the ray.
bool hit_triangles(const Scene::Parts& parts, const Ray& ray, Hit& hit);
bool are_triangles_hit(const Scene::Parts& parts, const Ray& ray, bool& is_hit);

/// Says which triangle below a placement was hit.
inline void name_placed_hit(const Scene::Parts& parts, const simd::PlacedHit& found, Hit& hit) {
  hit.instance_id = InstanceId(found.instance);
  hit.geometry_id = GeometryId(parts.placed_trees.items()[found.item].geometry);
  hit.primitive_id = PrimId(found.key);  // an object has one mesh, whose keys begin with 0
}

/// The closest hit, when `triangle` is that on a triangle (perhaps a miss).
Hit add_shapes(const Scene::Parts& parts, const Ray& ray, const Hit& triangle);
/// Whether any other shape is hit.
bool is_shape_hit(const Scene::Parts& parts, const Ray& ray);

/// Without a kernel, for any ray.
Hit walk_closest(const Scene::Parts& parts, const Ray& ray, NoStatistics& statistics);
Hit walk_closest(const Scene::Parts& parts, const Ray& ray, TraversalStatistics& statistics);
bool walk_any(const Scene::Parts& parts, const Ray& ray);

}  // namespace boxwood::detail
