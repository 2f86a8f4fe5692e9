#include "boxwood/scene/scene.h"

#include <algorithm>
#include <stdexcept>

#include "boxwood/scene/walk.h"

namespace boxwood {
namespace {

constexpr std::size_t kRaysPerTask = 1024;

Hit make_hit(const Scene::Parts& parts, const Crossing& crossing, InstanceId instance_id,
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

/// Keeps the first in the order of the contract.
struct ClosestSink {
  float t_max;
  Crossing crossing{};
  InstanceId instance_id{};
  PrimId primitive_id{};

  float limit() const { return t_max; }
  void report(const Crossing& c, InstanceId instance, PrimId primitive) {
    if (crossing.is_hit() && c.t == crossing.t) {
      // The geometry follows from the instance, so two ids and the part decide a tie.
      if (instance != instance_id
              ? instance > instance_id
              : (primitive != primitive_id ? primitive > primitive_id : c.part >= crossing.part))
        return;
    }
    crossing = c;
    instance_id = instance;
    primitive_id = primitive;
    t_max = c.t;
  }
};

/// Stops the walk at the first report.
struct AnySink {
  float t_max;
  bool found = false;
  float limit() const { return found ? -kInfinity : t_max; }
  void report(const Crossing&, InstanceId, PrimId) { found = true; }
};

/// Keeps everything.
struct AllSink {
  const Scene::Parts& parts;
  float t_max;
  std::vector<Hit>& hits;
  float limit() const { return t_max; }
  void report(const Crossing& c, InstanceId instance, PrimId primitive) {
    hits.push_back(make_hit(parts, c, instance, primitive));
  }
};

/// Works out the normal, once the hit is known.
void fill_normal(const Scene::Parts& parts, const PreparedRay& ray, Hit& hit) {
  const Geometry& geometry = parts.desc.geometries[hit.geometry_id.value];
  const Affine3& world_from_object = parts.instances[hit.instance_id.value].world_from_object;
  const Affine3& object_from_world = parts.object_from_world[hit.instance_id.value];
  const bool is_moved = !(world_from_object == Affine3::identity());

  Vec3 normal;
  if (const auto* mesh = std::get_if<TriangleMesh>(&geometry.shapes)) {
    normal = triangle_of(*mesh, hit.primitive_id).normal();
  } else {
    const Crossing crossing{hit.t, hit.u, hit.v, hit.part};
    const PreparedRay local =
        is_moved ? PreparedRay(object_from_world.point(ray.origin), object_from_world.vector(ray.direction),
                               -kInfinity, kInfinity, {})
                 : ray;
    normal = with_shape(geometry, hit.primitive_id,
                        [&](const auto& shape) { return shape.normal(local, crossing); });
  }
  hit.normal = is_moved ? normalize(transform_normal(object_from_world, normal)) : normal;
}

template <class Statistics>
Hit find_closest(const Scene::Parts& parts, const Ray& ray, Statistics& statistics) {
  const PreparedRay prepared(ray, parts.bounds);
  if (!prepared.is_valid()) return {};
  ClosestSink sink{prepared.t_max};
  detail::walk(parts, prepared, sink, statistics);
  if (!sink.crossing.is_hit()) return {};
  Hit hit = make_hit(parts, sink.crossing, sink.instance_id, sink.primitive_id);
  fill_normal(parts, prepared, hit);
  return hit;
}

void check_lengths(std::size_t rays, std::size_t hits) {
  if (rays != hits)
    throw std::invalid_argument("a batch of " + std::to_string(rays) + " rays came with room for " +
                                std::to_string(hits) + " hits, expected the same number");
}

}  // namespace

Scene::Scene(SceneDesc desc, const BuildOptions& options) : parts_(build_parts(std::move(desc), options)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

Hit Scene::closest_hit(const Ray& ray) const {
  NoStatistics none;
  return find_closest(*parts_, ray, none);
}

Hit Scene::closest_hit(const Ray& ray, TraversalStatistics& statistics) const {
  return find_closest(*parts_, ray, statistics);
}

bool Scene::any_hit(const Ray& ray) const {
  const PreparedRay prepared(ray, parts_->bounds);
  if (!prepared.is_valid()) return false;
  AnySink sink{prepared.t_max};
  NoStatistics none;
  detail::walk(*parts_, prepared, sink, none);
  return sink.found;
}

void Scene::all_hits(const Ray& ray, std::vector<Hit>& hits) const {
  hits.clear();
  const PreparedRay prepared(ray, parts_->bounds);
  if (!prepared.is_valid()) return;
  AllSink sink{*parts_, prepared.t_max, hits};
  NoStatistics none;
  detail::walk(*parts_, prepared, sink, none);
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return comes_before(a, b); });
  for (Hit& hit : hits) fill_normal(*parts_, prepared, hit);
}

void Scene::closest_hit(std::span<const Ray> rays, std::span<Hit> hits, Executor* executor) const {
  check_lengths(rays.size(), hits.size());
  parallel_for(executor ? *executor : default_executor(), 0, rays.size(), kRaysPerTask,
               [&](std::size_t i) { hits[i] = closest_hit(rays[i]); });
}

void Scene::any_hit(std::span<const Ray> rays, std::span<bool> hits, Executor* executor) const {
  check_lengths(rays.size(), hits.size());
  parallel_for(executor ? *executor : default_executor(), 0, rays.size(), kRaysPerTask,
               [&](std::size_t i) { hits[i] = any_hit(rays[i]); });
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
    add_tree(part.triangle_bvh);
    add_tree(part.shape_bvh);
    s.geometry_bytes += part.triangles.size() * sizeof(LeafTriangle) + part.shapes.size() * sizeof(LeafShape);
  };
  add_part(parts_->world);
  for (const Part& object : parts_->objects) add_part(object);
  add_tree(parts_->top_level);
  s.tree_bytes += parts_->placements.size() * sizeof(Placement);
  return s;
}

}  // namespace boxwood
