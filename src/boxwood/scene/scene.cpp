// scene.cpp: how is a ray answered?
//
// Kernels (simd/kernels.h) find what the ray does to triangles, in the world and below placements; rays that
// they do not take are walked by plain C++ (walk.h), with the same answer. Other shapes follow, within the
// limit that the triangles left. Batches are in batch.cpp.
#include "boxwood/scene/scene.h"

#include <algorithm>

#include "boxwood/scene/closest.h"

namespace boxwood {
namespace {

using detail::make_hit;

/// Keeps everything.
struct AllSink {
  static constexpr detail::Question kQuestion = detail::Question::all;
  const Scene::Parts& parts;
  float t_max;
  std::vector<Hit>& hits;
  float limit() const { return t_max; }
  void report(const Crossing& c, InstanceId instance, PrimId primitive) {
    hits.push_back(make_hit(parts, c, instance, primitive));
  }
};

/// Has a kernel list what the ray crosses of the world's triangles; false when none takes the ray.
bool ask_world(const Scene::Parts& parts, const Ray& ray, std::vector<simd::TriangleHit>& found) {
  if (parts.world.triangles.is_empty()) return true;
  return parts.kernels && parts.kernels->all_hits(parts.world.triangles, ray, parts.bounds, found);
}

/// Leaves one of each crossing of a triangle, which may stand in several leaves. `hits` are sorted.
void drop_repeated(const Scene::Parts& parts, std::vector<Hit>& hits) {
  const auto is_repeated = [&parts](const Hit& a, const Hit& b) {
    return a.t == b.t && a.instance_id == b.instance_id && a.primitive_id == b.primitive_id &&
           std::holds_alternative<TriangleMesh>(parts.desc.geometries[a.geometry_id.value].shapes);
  };
  hits.erase(std::unique(hits.begin(), hits.end(), is_repeated), hits.end());
}

}  // namespace

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

void Scene::all_hits(const Ray& ray, std::vector<Hit>& hits) const {
  hits.clear();
  const Parts& parts = *parts_;
  static thread_local std::vector<simd::TriangleHit> found;
  found.clear();
  const bool is_answered = ask_world(parts, ray, found);
  for (const simd::TriangleHit& hit : found) hits.push_back(detail::finish_triangle(parts, ray, hit));

  // Add what the kernel does not know.
  if (!is_answered || !parts.is_only_triangles) {
    const PreparedRay prepared(ray, parts.bounds);
    if (!prepared.is_valid()) return;
    const std::size_t first = hits.size();
    AllSink sink{parts, prepared.t_max, hits};
    NoStatistics none;
    if (!is_answered) detail::walk_triangles(parts.world, prepared, detail::NoPlacement{}, sink, none);
    detail::walk_others(parts, prepared, detail::Show::all, sink, none);
    for (std::size_t i = first; i < hits.size(); ++i) detail::fill_normal(parts, prepared, hits[i]);
  }
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return comes_before(a, b); });
  drop_repeated(parts, hits);
}

std::size_t Scene::count_hits(const Ray& ray) const {
  // Where there are only triangles, their keys say which crossings are the same.
  const Parts& parts = *parts_;
  static thread_local std::vector<simd::TriangleHit> found;
  found.clear();
  if (parts.is_only_triangles && ask_world(parts, ray, found)) {
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    const auto last =
        std::unique(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.key == b.key; });
    return static_cast<std::size_t>(last - found.begin());
  }
  std::vector<Hit> hits;
  all_hits(ray, hits);
  return hits.size();
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
