// walk.h: how does a ray question walk the two levels of a scene?
//
// One walk for closest, any and all hits: they differ only in their sink. Below a placement the ray is in
// object space, and each crossing passes two gates (shape/gate.h): that of its own box, and that of the
// placement's world box. Plain C++, but for the triangles below a placement, which a kernel (simd/kernels.h)
// answers for when it takes the ray; for the world's triangles the caller asks it first.
#pragma once

#include "boxwood/query/traverse_wide.h"
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

/// What a sink is there for; says which kernel serves it.
enum class Question { closest, any, all };

/// Shows every leaf of the tree that may matter to `query`, whatever the tree's layout and width.
template <int W, WideQuery Q, class Statistics>
void traverse_triangles_as(const simd::TriangleTree& tree, Q& query, Statistics& statistics) {
  if (tree.layout() == simd::Layout::full)
    traverse_wide<W>(
        [&](ChildRef node) -> const auto& { return tree.full_node<W>(node); }, query, statistics);
  else
    traverse_wide<W>(
        [&](ChildRef node) -> const auto& { return tree.compact_node<W>(node); }, query, statistics);
}
template <WideQuery Q, class Statistics>
void traverse_triangles(const simd::TriangleTree& tree, Q& query, Statistics& statistics) {
  if (tree.is_empty()) return;
  with_width(tree.width(), [&](auto w) { traverse_triangles_as<w()>(tree, query, statistics); });
}

/// Names the crossings of one triangle, once there are any.
template <class Above, class Sink>
struct LabelledByKey {
  Sink& sink;
  const Part& part;
  const Above& above;
  std::uint32_t key;
  float limit() const { return sink.limit(); }
  void report(const Crossing& crossing) {
    const PartMesh& mesh = part.mesh_of(key);
    sink.report(crossing, above.name(mesh.instance_id), PrimId(key - mesh.first_key));
  }
};

/// Meets the triangles of a Part.
template <class Above, class Sink, class Statistics>
class TriangleQuery {
 public:
  TriangleQuery(const PreparedRay& ray, const Part& part, const Above& above, Sink& sink,
                Statistics& statistics)
      : ray_(ray),
        box_ray_(part.triangles.has_parts() ? ray.widened(kPartSlack) : ray),
        part_(part),
        above_(above),
        sink_(sink),
        statistics_(statistics) {}

  float bound(const Box3& box) const { return box_ray_.bound(box); }
  float limit() const {
    Labelled<Sink> any{sink_, {}, {}};
    return above_.gate(any).limit();
  }
  void visit(ChildRef leaf) {
    for (std::uint32_t i = 0; i < leaf.blocks(); ++i) {
      const simd::TriangleBlock block = part_.triangles.block_of(leaf, i);
      for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
        if (is_padding(block.key, static_cast<int>(lane))) continue;
        statistics_.count_shapes(1);
        LabelledByKey<Above, Sink> labelled{sink_, part_, above_, block.key[lane]};
        auto&& gate = above_.gate(labelled);
        intersect_gated(ray_, block.triangle(lane), gate);
      }
    }
  }

 private:
  const PreparedRay& ray_;
  const PreparedRay box_ray_;
  const Part& part_;
  const Above& above_;
  Sink& sink_;
  Statistics& statistics_;
};

/// Meets the other shapes of a Part.
template <class Above, class Sink>
class ShapeQuery {
 public:
  ShapeQuery(const PreparedRay& ray, const SceneDesc& desc, const Part& part, const Above& above, Sink& sink)
      : ray_(ray), desc_(desc), part_(part), above_(above), sink_(sink) {}

  float bound(const Box3& box) const { return ray_.bound(box); }
  float limit() const {
    Labelled<Sink> any{sink_, {}, {}};
    return above_.gate(any).limit();
  }
  void visit(PrimId id) {
    const LeafShape& item = part_.shapes[id.value];
    Labelled<Sink> labelled{sink_, above_.name(item.instance_id), item.primitive_id};
    auto&& gate = above_.gate(labelled);
    with_shape(desc_.geometries[item.geometry_id.value], item.primitive_id,
               [&](const auto& shape) { intersect_gated(ray_, shape, gate); });
  }

 private:
  const PreparedRay& ray_;
  const SceneDesc& desc_;
  const Part& part_;
  const Above& above_;
  Sink& sink_;
};

template <class Above, class Sink, class Statistics>
void walk_triangles(const Part& part, const PreparedRay& ray, const Above& above, Sink& sink,
                    Statistics& statistics) {
  TriangleQuery<Above, Sink, Statistics> triangles(ray, part, above, sink, statistics);
  traverse_triangles(part.triangles, triangles, statistics);
}

template <class Above, class Sink, class Statistics>
void walk_shapes(const Scene::Parts& parts, const Part& part, const PreparedRay& ray, const Above& above,
                 Sink& sink, Statistics& statistics) {
  ShapeQuery<Above, Sink> shapes(ray, parts.desc, part, above, sink);
  traverse(part.shape_bvh, shapes, statistics);
}

/// What a walk is to show: triangles may have been answered for already.
enum class Show { all, other_shapes };

/// Meets placements: takes the ray into object space and walks there.
template <class Sink, class Statistics>
class PlacementQuery {
 public:
  PlacementQuery(const Scene::Parts& parts, const PreparedRay& ray, Show show, Sink& sink,
                 Statistics& statistics)
      : parts_(parts), ray_(ray), show_(show), sink_(sink), statistics_(statistics) {}

  float bound(const Box3& box) const { return ray_.bound(box); }
  float limit() const { return sink_.limit(); }
  void visit(PrimId id) {
    const Placement& placement = parts_.placements[id.value];
    const Part& part = parts_.objects[placement.part_index];
    if (show_ == Show::other_shapes && part.shapes.empty()) return;
    const UnderPlacement above{ray_, ray_.interval(placement.world_box), placement.instance_id};
    if (above.inside.is_empty()) return;
    Labelled<Sink> any{sink_, {}, {}};
    const Ray ray{placement.object_from_world.point(ray_.origin), inner_t_min(ray_, above.inside),
                  placement.object_from_world.vector(ray_.direction), above.gate(any).limit()};
    const bool is_answered = show_ == Show::other_shapes ||
                             (std::is_same_v<Statistics, NoStatistics> && ask_kernel(part, ray, above));
    if (is_answered && part.shapes.empty()) return;
    const PreparedRay local(ray.origin, ray.direction, ray.t_min, ray.t_max, part.bounds);
    if (!local.is_valid()) return;
    if (!is_answered) walk_triangles(part, local, above, sink_, statistics_);
    walk_shapes(parts_, part, local, above, sink_, statistics_);
  }

 private:
  /// Has a kernel list what the ray crosses of the part's triangles; false when there is none that takes the
  /// ray. (First hits below placements are found by kernels that walk both levels. Rays that these refuse are
  /// few, and left to plain C++.)
  bool ask_kernel(const Part& part, const Ray& ray, const UnderPlacement& above) {
    const simd::TriangleTree& tree = part.triangles;
    if (tree.is_empty()) return true;
    const simd::Kernels* kernels = simd::kernels();
    if (Sink::kQuestion != Question::all || !kernels || !tree.is_ordinary()) return false;
    std::vector<simd::TriangleHit> found;
    const simd::Passage passage{above.inside, ray_.t_min};
    if (!kernels->placed_all_hits(tree, ray, part.bounds, passage, sink_.limit(), found)) return false;
    for (const simd::TriangleHit& hit : found) {
      const Triangle triangle = tree.triangle(hit.block, hit.lane);
      Crossing crossing;
      intersect_triangle(RayShear(ray.origin, ray.direction), triangle.a, triangle.b, triangle.c, crossing);
      crossing.t = hit.t;
      LabelledByKey<UnderPlacement, Sink>{sink_, part, above, hit.key}.report(crossing);
    }
    return true;
  }

  const Scene::Parts& parts_;
  const PreparedRay& ray_;
  Show show_;
  Sink& sink_;
  Statistics& statistics_;
};

/// Has a kernel find the placements that `query` must visit; false when there is none that takes the ray.
template <class Query>
bool visit_placements(const Scene::Parts& parts, const PreparedRay& ray, Query& query) {
  if (parts.placed_trees.is_empty()) return true;
  if (parts.placements.size() == 1) {  // which tells by itself that a ray passes it
    query.visit(PrimId(0));
    return true;
  }
  const simd::Kernels* kernels = simd::kernels();
  const simd::BoxTree& boxes = parts.placed_trees.boxes();
  if (!kernels || !boxes.is_ordinary()) return false;
  const auto visit = [](void* context, std::uint32_t item) {
    Query& asked = *static_cast<Query*>(context);
    asked.visit(PrimId(item));
    return asked.limit();
  };
  return kernels->visit_boxes(boxes, {ray.origin, ray.t_min, ray.direction, query.limit()}, parts.bounds,
                              visit, &query);
}

/// Shows `sink` everything that `ray` may meet but the world's triangles, or all other shapes:
/// sink.limit(), sink.report(crossing, instance_id, primitive_id).
template <class Sink, class Statistics>
void walk_others(const Scene::Parts& parts, const PreparedRay& ray, Show show, Sink& sink,
                 Statistics& statistics) {
  walk_shapes(parts, parts.world, ray, NoPlacement{}, sink, statistics);
  if (show == Show::other_shapes && !parts.has_placed_shapes) return;
  PlacementQuery<Sink, Statistics> placements(parts, ray, show, sink, statistics);
  if (!std::is_same_v<Statistics, NoStatistics> || !visit_placements(parts, ray, placements))
    traverse(parts.top_level, placements, statistics);
}

/// Everything.
template <class Sink, class Statistics>
void walk(const Scene::Parts& parts, const PreparedRay& ray, Sink& sink, Statistics& statistics) {
  walk_triangles(parts.world, ray, NoPlacement{}, sink, statistics);
  walk_others(parts, ray, Show::all, sink, statistics);
}

}  // namespace boxwood::detail
