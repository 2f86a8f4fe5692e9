// parts.h: what stands behind a Scene?
//
// A Part is everything that one tree level needs: the triangles of one space in a wide tree, packed for the
// kernels, and the other shapes with a binary tree. The world is one Part (all geometry that is placed
// without a transform); each geometry that is placed under a transform is a Part in its own object space,
// shared by its placements, and a top-level tree organises the placements.
#pragma once

#include "boxwood/scene/ball.h"
#include "boxwood/scene/scene.h"
#include "boxwood/simd/box_tree.h"
#include "boxwood/simd/kernels.h"

namespace boxwood {

/// A mesh of a Part. The triangles of all its meshes are numbered one behind the other, in the order of the
/// instances: that number is the triangle's key in the tree, so ties by key are ties by (instance,
/// primitive).
struct PartMesh {
  std::uint32_t first_key;
  InstanceId instance_id;  ///< None inside an object's Part: there the placement says it.
  GeometryId geometry_id;
};

/// Any other shape, named by where the description holds it.
struct LeafShape {
  GeometryId geometry_id;
  InstanceId instance_id;
  PrimId primitive_id;
};

struct Part {
  simd::TriangleTree triangles;
  std::vector<PartMesh> meshes;  ///< By first_key.
  bool may_sort_rays = false;    ///< See ray_order.h.
  Bvh shape_bvh;                 ///< prim_ids count 0, 1, 2, ...: the shapes stand in leaf order.
  std::vector<LeafShape> shapes;
  Box3 bounds;

  static constexpr int kPageBits = 10;
  std::vector<std::uint32_t> mesh_of_page;  ///< The mesh of each 2^kPageBits-th key, and the last mesh.

  /// The mesh of a triangle; the primitive is `key` less its first_key. This runs once for each hit: the page
  /// leaves few meshes, mostly one, to search among by halving.
  const PartMesh& mesh_of(std::uint32_t key) const {
    const std::uint32_t* page = &mesh_of_page[key >> kPageBits];
    const PartMesh* mesh = &meshes[page[0]];
    for (std::size_t left = page[1] - page[0] + 1; left > 1;) {
      const std::size_t half = left / 2;
      mesh += half * static_cast<std::size_t>(mesh[half].first_key <= key);
      left -= half;
    }
    return *mesh;
  }
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
  std::vector<Affine3> object_from_world;  ///< InstanceId -> the inverse of its transform;
  std::vector<char> is_moved;              ///< and whether that is another than the identity.
  Part world;
  std::vector<Part> objects;
  std::vector<Placement> placements;
  Bvh top_level;                   ///< Over the world boxes of `placements`;
  simd::PlacedTrees placed_trees;  ///< and the same, with what stands there, for kernels.
  Box3 bounds;
  /// Those for all triangles; null when plain C++ is to walk, as it does when any tree of them is not
  /// ordinary.
  const simd::Kernels* kernels = nullptr;
  bool has_shapes = false;         ///< Other than triangles, anywhere;
  bool has_placed_shapes = false;  ///< and below placements;
  Ball shapes_ball;                ///< around all of them.
  bool is_only_triangles = false;  ///< The world's: no other shape and no placement.
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
