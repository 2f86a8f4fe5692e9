// walk.h: how does a ray question walk the two levels of a scene?
//
// One walk for closest, any and all hits: they differ only in their sink. Below a placement the ray is in
// object space, and each crossing passes two gates (shape/gate.h): that of its own box, and that of the
// placement's world box.
#pragma once

#include "boxwood/scene/parts.h"
#include "boxwood/shape/gate.h"

namespace boxwood::detail {

/// Names the crossings of one primitive for the scene's sink.
template <class Sink>
struct Labelled {
  Sink& sink;
  InstanceId instance_id;
  PrimId primitive_id;
  float limit() const { return sink.limit(); }
  void report(const Crossing& crossing) { sink.report(crossing, instance_id, primitive_id); }
};

/// In the world: nothing stands between a primitive and the sink.
struct NoPlacement {
  template <class Sink>
  Sink& gate(Sink& sink) const {
    return sink;
  }
  InstanceId name(InstanceId own) const { return own; }
};

/// Below a placement: its world box is a gate, and it says the instance.
struct UnderPlacement {
  const PreparedRay& world_ray;
  Interval inside;
  InstanceId instance_id;
  template <class Sink>
  BoxGate<Sink> gate(Sink& sink) const {
    return {world_ray, inside, sink};
  }
  InstanceId name(InstanceId) const { return instance_id; }
};

/// Meets the triangles (or the other shapes) of a Part.
template <class Item, class Above, class Sink>
class PartQuery {
 public:
  PartQuery(const PreparedRay& ray, const SceneDesc& desc, const std::vector<Item>& items, const Above& above,
            Sink& sink)
      : ray_(ray), desc_(desc), items_(items), above_(above), sink_(sink) {}

  float bound(const Box3& box) const { return ray_.bound(box); }
  float limit() const {
    Labelled<Sink> any{sink_, {}, {}};
    return above_.gate(any).limit();
  }
  void visit(PrimId id) {
    const Item& item = items_[id.value];
    Labelled<Sink> labelled{sink_, above_.name(item.instance_id), item.primitive_id};
    auto&& gate = above_.gate(labelled);
    if constexpr (std::is_same_v<Item, LeafTriangle>)
      intersect_gated(ray_, Triangle{item.a, item.b, item.c}, gate);
    else
      with_shape(desc_.geometries[item.geometry_id.value], item.primitive_id,
                 [&](const auto& shape) { intersect_gated(ray_, shape, gate); });
  }

 private:
  const PreparedRay& ray_;
  const SceneDesc& desc_;
  const std::vector<Item>& items_;
  const Above& above_;
  Sink& sink_;
};

template <class Above, class Sink, class Statistics>
void walk_part(const Scene::Parts& parts, const Part& part, const PreparedRay& ray, const Above& above,
               Sink& sink, Statistics& statistics) {
  PartQuery<LeafTriangle, Above, Sink> triangles(ray, parts.desc, part.triangles, above, sink);
  traverse(part.triangle_bvh, triangles, statistics);
  PartQuery<LeafShape, Above, Sink> shapes(ray, parts.desc, part.shapes, above, sink);
  traverse(part.shape_bvh, shapes, statistics);
}

/// Meets placements: takes the ray into object space and walks there.
template <class Sink, class Statistics>
class PlacementQuery {
 public:
  PlacementQuery(const Scene::Parts& parts, const PreparedRay& ray, Sink& sink, Statistics& statistics)
      : parts_(parts), ray_(ray), sink_(sink), statistics_(statistics) {}

  float bound(const Box3& box) const { return ray_.bound(box); }
  float limit() const { return sink_.limit(); }
  void visit(PrimId id) {
    const Placement& placement = parts_.placements[id.value];
    const UnderPlacement above{ray_, ray_.interval(placement.world_box), placement.instance_id};
    if (above.inside.is_empty()) return;
    const Part& part = parts_.objects[placement.part_index];
    Labelled<Sink> any{sink_, {}, {}};
    const PreparedRay local(placement.object_from_world.point(ray_.origin),
                            placement.object_from_world.vector(ray_.direction),
                            inner_t_min(ray_, above.inside), above.gate(any).limit(), part.bounds);
    if (local.is_valid()) walk_part(parts_, part, local, above, sink_, statistics_);
  }

 private:
  const Scene::Parts& parts_;
  const PreparedRay& ray_;
  Sink& sink_;
  Statistics& statistics_;
};

/// Shows `sink` everything that `ray` may meet:
/// sink.limit(), sink.report(crossing, instance_id, primitive_id).
template <class Sink, class Statistics>
void walk(const Scene::Parts& parts, const PreparedRay& ray, Sink& sink, Statistics& statistics) {
  walk_part(parts, parts.world, ray, NoPlacement{}, sink, statistics);
  PlacementQuery<Sink, Statistics> placements(parts, ray, sink, statistics);
  traverse(parts.top_level, placements, statistics);
}

}  // namespace boxwood::detail
