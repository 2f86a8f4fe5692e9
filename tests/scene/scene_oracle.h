// scene_oracle.h: what would a scene answer if it had no trees?
//
// Visits every primitive of every instance through the
// same leaf rules (shape/gate.h) and sorts by the contract.
#pragma once

#include <algorithm>

#include "boxwood/scene/parts.h"
#include "boxwood/shape/gate.h"

namespace boxwood::test {

struct OracleSink {
  float t_max;
  std::vector<Hit>& hits;
  Hit label;
  float limit() const { return t_max; }
  void report(const Crossing& c) {
    Hit hit = label;
    hit.t = c.t, hit.u = c.u, hit.v = c.v, hit.part = c.part;
    hits.push_back(hit);
  }
};

/// Meets every primitive of `geometry` with `ray`; `gate` stands before the sink.
template <class Gate>
void meet_all(const Geometry& geometry, const PreparedRay& ray, PrimId id, Gate& gate) {
  if (const auto* mesh = std::get_if<TriangleMesh>(&geometry.shapes))
    intersect_gated(ray, triangle_of(*mesh, id), gate);
  else
    with_shape(geometry, id, [&](const auto& shape) { intersect_gated(ray, shape, gate); });
}

/// Every crossing in the order of the contract; normals are left zero.
inline std::vector<Hit> all_hits_without_trees(const Scene& scene, const Ray& ray) {
  const Scene::Parts& parts = scene.parts();
  std::vector<Hit> hits;
  const PreparedRay world(ray, scene.bounds());
  if (!world.is_valid()) return hits;
  for (std::size_t i = 0; i < parts.instances.size(); ++i) {
    const Instance& instance = parts.instances[i];
    const Geometry& geometry = parts.desc.geometries[instance.geometry.value];
    OracleSink sink{world.t_max, hits, {}};
    sink.label.instance_id = InstanceId(i);
    sink.label.geometry_id = instance.geometry;

    const bool is_moved = !(instance.world_from_object == Affine3::identity());
    Box3 object_box;
    for (std::size_t p = 0; p < primitive_count(geometry); ++p) {
      if (const auto* mesh = std::get_if<TriangleMesh>(&geometry.shapes))
        object_box.extend(triangle_of(*mesh, PrimId(p)).box());
      else
        with_shape(geometry, PrimId(p), [&](const auto& shape) { object_box.extend(shape.box()); });
    }
    const Affine3 back = inverse(instance.world_from_object);
    const Interval inside = world.interval(transform_box(instance.world_from_object, object_box));
    for (std::size_t p = 0; p < primitive_count(geometry); ++p) {
      sink.label.primitive_id = PrimId(p);
      if (!is_moved) {
        meet_all(geometry, world, PrimId(p), sink);
      } else {
        if (inside.is_empty()) continue;
        const PreparedRay local(back.point(world.origin), back.vector(world.direction), -kInfinity, kInfinity,
                                object_box);
        BoxGate<OracleSink> gate(world, inside, sink);
        if (local.is_valid()) meet_all(geometry, local, PrimId(p), gate);
      }
    }
  }
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return comes_before(a, b); });
  return hits;
}

}  // namespace boxwood::test
