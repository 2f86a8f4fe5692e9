// parts.h: what stands behind a Scene?
//
// A Part is everything that one tree level needs: the triangles and the other shapes of one space, each with
// a binary tree. The world is one Part (all geometry that is placed without a transform); each geometry that
// is placed under a transform is a Part in its own object space, shared by its placements, and a top-level
// tree organises the placements.
#pragma once

#include "boxwood/scene/scene.h"

namespace boxwood {

/// A triangle as the leaves hold it: no indirection to a vertex.
struct LeafTriangle {
  Vec3 a, b, c;
  InstanceId instance_id;  ///< None inside an object's Part: there the placement says it.
  PrimId primitive_id;
};

/// Any other shape, named by where the description holds it.
struct LeafShape {
  GeometryId geometry_id;
  InstanceId instance_id;
  PrimId primitive_id;
};

struct Part {
  Bvh triangle_bvh;  ///< prim_ids count 0, 1, 2, ...: the triangles stand in leaf order.
  std::vector<LeafTriangle> triangles;
  Bvh shape_bvh;  ///< The same for shapes.
  std::vector<LeafShape> shapes;
  Box3 bounds;
};

/// A geometry under a transform.
struct Placement {
  InstanceId instance_id;
  std::uint32_t part_index;
  Affine3 world_from_object, object_from_world;
  Box3 world_box;
  bool is_similarity;  ///< Turns, mirrors and scales evenly: keeps which point is nearest.
};

struct Scene::Parts {
  SceneDesc desc;
  std::vector<Instance> instances;         ///< InstanceId -> placed_instances(desc).
  std::vector<Affine3> object_from_world;  ///< InstanceId -> the inverse of its transform.
  Part world;
  std::vector<Part> objects;
  std::vector<Placement> placements;
  Bvh top_level;  ///< Over the world boxes of `placements`.
  Box3 bounds;
  double build_ms = 0;
  std::string closest_point_obstacle;  ///< Why closest_point cannot be answered; empty when it can.
};

/// Checks `desc` and builds every tree. Errors as in Scene's constructor.
std::unique_ptr<const Scene::Parts> build_parts(SceneDesc desc, const BuildOptions& options);

/// Calls f(shape) with the shape of its own type. Precondition: `id` names a shape that is not a triangle.
template <class F>
decltype(auto) with_shape(const Geometry& geometry, PrimId id, F&& f) {
  if (auto* s = std::get_if<std::vector<Sphere>>(&geometry.shapes)) return f((*s)[id.value]);
  if (auto* s = std::get_if<std::vector<Quad>>(&geometry.shapes)) return f((*s)[id.value]);
  if (auto* s = std::get_if<std::vector<Cuboid>>(&geometry.shapes)) return f((*s)[id.value]);
  if (auto* s = std::get_if<std::vector<Disk>>(&geometry.shapes)) return f((*s)[id.value]);
  return f(std::get<std::vector<AnyShape>>(geometry.shapes)[id.value]);
}

/// The triangle of a mesh, in object space.
inline Triangle triangle_of(const TriangleMesh& mesh, PrimId id) {
  const auto& [i, j, k] = mesh.indices[id.value];
  return {mesh.positions[i], mesh.positions[j], mesh.positions[k]};
}

}  // namespace boxwood
