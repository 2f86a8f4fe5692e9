// scene.cpp: how is a ray answered?
//
// Kernels (simd/kernels.h) find what the ray does to triangles, in the world and below placements; rays that
// they do not take are walked by plain C++ (walk.h), with the same answer. Other shapes follow, within the
// limit that the triangles left. Batches are in batch.cpp, all crossings in all_hits.cpp.
#include "boxwood/scene/scene.h"

#include "boxwood/scene/closest.h"

namespace boxwood {

Scene::Scene(SceneDesc desc, const BuildOptions& options) : parts_(build_parts(std::move(desc), options)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

Hit Scene::closest_hit(const Ray& ray) const {
  Hit hit;
  if (detail::hit_triangles(*parts_, ray, hit))
    return parts_->has_shapes ? detail::add_shapes(*parts_, ray, hit) : hit;
  NoStatistics none;
  return detail::walk_closest(*parts_, ray, none);
}

Hit Scene::closest_hit(const Ray& ray, TraversalStatistics& statistics) const {
  return detail::walk_closest(*parts_, ray, statistics);
}

bool Scene::any_hit(const Ray& ray) const {
  bool is_hit = false;
  if (detail::are_triangles_hit(*parts_, ray, is_hit))
    return is_hit || (parts_->has_shapes && detail::is_shape_hit(*parts_, ray));
  return detail::walk_any(*parts_, ray);
}

const SceneDesc& Scene::description() const {
  return parts_->desc;
}
Box3 Scene::bounds() const {
  return parts_->bounds;
}

SceneStatistics Scene::statistics() const {
  SceneStatistics s;
  s.primitives = shown_primitive_count(parts_->desc);
  s.build_ms = parts_->build_ms;
  const auto add_tree = [&](const Bvh& bvh) {
    if (bvh.is_empty()) return;
    ++s.trees;
    s.nodes += bvh.nodes.size();
    s.tree_bytes += bvh.size_bytes();
  };
  const auto add_part = [&](const Part& part) {
    if (!part.triangles.is_empty()) {
      ++s.trees;
      s.nodes += part.triangles.node_count();
      s.tree_bytes += part.triangles.node_bytes();
      s.geometry_bytes += part.triangles.size_bytes() - part.triangles.node_bytes();
    }
    add_tree(part.shape_bvh);
    s.geometry_bytes += part.shapes.size() * sizeof(LeafShape) + part.meshes.size() * sizeof(PartMesh);
  };
  add_part(parts_->world);
  for (const Part& object : parts_->objects) add_part(object);
  add_tree(parts_->top_level);
  s.tree_bytes += parts_->placed_trees.size_bytes() + parts_->placements.size() * sizeof(Placement);
  return s;
}

}  // namespace boxwood
