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

/// The hit on a triangle of the world. Precondition: found.is_hit().
inline Hit finish_triangle(const Scene::Parts& parts, const Ray& ray, const simd::TriangleHit& found) {
  const simd::TriangleBlock& block = parts.world.triangles.block_at(found.block);
  const Triangle triangle = block.triangle(found.lane);

  // Take the coordinates in the order of the test, so that it need not pick them one by one.
  RayShear shear(ray.origin, ray.direction);
  const auto turned = [&shear](const auto& at) {
    return Vec3{at(shear.axis_x), at(shear.axis_y), at(shear.axis_z)};
  };
  const auto vertex = [&](int k) { return turned([&](int axis) { return block.v[k][axis][found.lane]; }); };
  const Vec3 a = vertex(0), b = vertex(1), c = vertex(2);
  shear.origin = turned([&ray](int axis) { return (&ray.origin.x)[axis]; });
  shear.axis_x = 0, shear.axis_y = 1, shear.axis_z = 2;
  Crossing crossing;
  intersect_triangle(shear, a, b, c, crossing);
  const PartMesh& mesh = parts.world.mesh_of(found.key);
  Hit hit;
  hit.t = found.t;
  hit.u = crossing.u;
  hit.v = crossing.v;
  hit.normal = triangle.normal();
  hit.instance_id = mesh.instance_id;
  hit.geometry_id = mesh.geometry_id;
  hit.primitive_id = PrimId(found.key - mesh.first_key);
  return hit;
}

/// Works out the normal from the description.
void fill_normal(const Scene::Parts& parts, const PreparedRay& ray, Hit& hit);

/// The closest hit, when `triangle` is what the ray does to the world's triangles (perhaps a miss). `ray` is
/// one that the kernel took.
Hit add_others(const Scene::Parts& parts, const Ray& ray, const simd::TriangleHit& triangle);
inline Hit finish_closest(const Scene::Parts& parts, const Ray& ray, const simd::TriangleHit& triangle) {
  if (!parts.is_only_triangles) return add_others(parts, ray, triangle);
  return triangle.is_hit() ? finish_triangle(parts, ray, triangle) : Hit{};
}

/// Without a kernel, for any ray.
Hit walk_closest(const Scene::Parts& parts, const Ray& ray, NoStatistics& statistics);
Hit walk_closest(const Scene::Parts& parts, const Ray& ray, TraversalStatistics& statistics);
bool walk_any(const Scene::Parts& parts, const Ray& ray);

/// Whether anything is hit but the world's triangles.
bool is_other_hit(const Scene::Parts& parts, const Ray& ray);

}  // namespace boxwood::detail
