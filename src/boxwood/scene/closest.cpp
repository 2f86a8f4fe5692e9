#include "boxwood/scene/closest.h"

namespace boxwood::detail {
namespace {

/// Keeps the first in the order of the contract.
struct ClosestSink {
  static constexpr Question kQuestion = Question::closest;
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
  static constexpr Question kQuestion = Question::any;
  float t_max;
  bool found = false;
  float limit() const { return found ? -kInfinity : t_max; }
  void report(const Crossing&, InstanceId, PrimId) { found = true; }
};

template <class Statistics>
Hit find_closest(const Scene::Parts& parts, const Ray& ray, Statistics& statistics) {
  const PreparedRay prepared(ray, parts.bounds);
  if (!prepared.is_valid()) return {};
  ClosestSink sink{prepared.t_max};
  walk(parts, prepared, sink, statistics);
  if (!sink.crossing.is_hit()) return {};
  Hit hit = make_hit(parts, sink.crossing, sink.instance_id, sink.primitive_id);
  fill_normal(parts, prepared, hit);
  return hit;
}

}  // namespace

void fill_normal(const Scene::Parts& parts, const PreparedRay& ray, Hit& hit) {
  const Geometry& geometry = parts.desc.geometries[hit.geometry_id.value];
  const Affine3& object_from_world = parts.object_from_world[hit.instance_id.value];
  const bool is_moved = parts.is_moved[hit.instance_id.value];

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

bool hit_triangles(const Scene::Parts& parts, const Ray& ray, Hit& hit) {
  if (!parts.kernels) return false;
  simd::PlacedHit placed{{ray.t_max + 0.0f}};
  if (!parts.world.triangles.is_empty()) {
    simd::TriangleHit found;
    if (!parts.kernels->closest_full_hit(parts.world.triangles, ray, parts.bounds, found, hit)) return false;
    if (found.is_hit()) {
      name_hit(parts.world, found.key, hit);
      placed.t = hit.t;
      placed.instance = hit.instance_id.value;
    }
  }
  if (!parts.placed_trees.has_triangles()) return true;
  if (!parts.kernels->closest_hit_below(parts.placed_trees, ray, parts.bounds, placed, hit)) return false;
  if (placed.is_placed()) name_placed_hit(parts, placed, hit);
  return true;
}

bool are_triangles_hit(const Scene::Parts& parts, const Ray& ray, bool& is_hit) {
  if (!parts.kernels) return false;
  if (!parts.world.triangles.is_empty()) {
    if (!parts.kernels->any_hit(parts.world.triangles, ray, parts.bounds, is_hit)) return false;
    if (is_hit) return true;
  }
  return !parts.placed_trees.has_triangles() ||
         parts.kernels->any_hit_below(parts.placed_trees, ray, parts.bounds, is_hit);
}

Hit add_shapes(const Scene::Parts& parts, const Ray& ray, const Hit& triangle) {
  if (!parts.shapes_ball.may_meet(ray, min(ray.t_max, triangle.t))) return triangle;

  // Begin with the triangle, as if the walk had met it first.
  const PreparedRay prepared(ray, parts.bounds);
  if (!prepared.is_valid()) return {};
  ClosestSink sink{prepared.t_max};
  if (triangle.is_hit())
    sink.report({triangle.t, triangle.u, triangle.v, 0}, triangle.instance_id, triangle.primitive_id);
  NoStatistics none;
  walk_others(parts, prepared, Show::other_shapes, sink, none);
  if (!sink.crossing.is_hit()) return {};
  if (sink.instance_id == triangle.instance_id) return triangle;  // no other shape has its instance
  Hit hit = make_hit(parts, sink.crossing, sink.instance_id, sink.primitive_id);
  fill_normal(parts, prepared, hit);
  return hit;
}

bool is_shape_hit(const Scene::Parts& parts, const Ray& ray) {
  if (!parts.shapes_ball.may_meet(ray, ray.t_max)) return false;
  const PreparedRay prepared(ray, parts.bounds);
  if (!prepared.is_valid()) return false;
  AnySink sink{prepared.t_max};
  NoStatistics none;
  walk_others(parts, prepared, Show::other_shapes, sink, none);
  return sink.found;
}

Hit walk_closest(const Scene::Parts& parts, const Ray& ray, NoStatistics& statistics) {
  return find_closest(parts, ray, statistics);
}
Hit walk_closest(const Scene::Parts& parts, const Ray& ray, TraversalStatistics& statistics) {
  return find_closest(parts, ray, statistics);
}

bool walk_any(const Scene::Parts& parts, const Ray& ray) {
  const PreparedRay prepared(ray, parts.bounds);
  if (!prepared.is_valid()) return false;
  AnySink sink{prepared.t_max};
  NoStatistics none;
  walk(parts, prepared, sink, none);
  return sink.found;
}

}  // namespace boxwood::detail
