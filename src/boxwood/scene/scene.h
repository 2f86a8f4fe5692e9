// scene.h: what does a ray hit in a whole scene? The hall: built once, read-only from then on.
//
// Geometry that stands in the world as it was defined shares one tree; geometry under a transform has a tree
// of its own, in object space, below a tree of instances. The answer is the same either way up to the
// rounding of the transform.
#pragma once

#include <memory>
#include <span>

#include "boxwood/build/options.h"
#include "boxwood/core/hit.h"
#include "boxwood/core/ray.h"
#include "boxwood/query/traverse.h"
#include "boxwood/scene/description.h"

namespace boxwood {

/// The point of a surface nearest to a given one; a miss has distance = +inf and no ids.
struct ScenePoint {
  float distance = kInfinity;
  Vec3 position;
  InstanceId instance_id;
  GeometryId geometry_id;
  PrimId primitive_id;
  friend bool operator==(const ScenePoint&, const ScenePoint&) = default;
};

/// Sizes of what was built, beside the description that the scene keeps.
struct SceneStatistics {
  std::size_t primitives = 0;  ///< Shown: each instance counts.
  std::size_t trees = 0, nodes = 0;
  std::size_t tree_bytes = 0;      ///< Nodes, and the placements that the top-level tree organises.
  std::size_t geometry_bytes = 0;  ///< What the leaves hold: triangles in blocks, names of other shapes.
  double build_ms = 0;
};

/// Answers are the same bits on every machine in the floating-point mode that a program starts with: rounding
/// to nearest, denormals kept. A thread that flushes denormals to zero gets answers as watertight as any,
/// whose last bits may differ where numbers below 1e-38 come in.
class Scene {
 public:
  /// Checks and copies the geometry and builds the trees.
  /// Throws std::invalid_argument (see check), Cancelled.
  explicit Scene(SceneDesc desc, const BuildOptions& options = BuildOptions::balanced());
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// The closest hit in [t_min, t_max]; equal t goes to the smallest (instance, geometry, primitive). A miss
  /// has t = +inf. Any number of threads may ask; nothing is allocated or locked.
  Hit closest_hit(const Ray& ray) const;
  /// Whether anything is hit in [t_min, t_max].
  bool any_hit(const Ray& ray) const;
  /// Every crossing in [t_min, t_max] once,
  /// in the order of the contract (comes_before). Replaces what `hits` holds.
  void all_hits(const Ray& ray, std::vector<Hit>& hits) const;
  /// How many crossings there are in [t_min, t_max]: the number of all_hits, without working them out.
  std::size_t count_hits(const Ray& ray) const;

  /// The same for many rays, in any order, and faster: hits[i] answers rays[i], bit for bit as the call with
  /// one ray. Throws std::invalid_argument when the lengths differ. Uses `executor`, by default oneTBB; up to
  /// a few hundred rays are answered on the calling thread. Where order pays (ray_order.h) large batches are
  /// sorted first, which takes 16 bytes for each of a million rays at a time.
  void closest_hit(std::span<const Ray> rays, std::span<Hit> hits, Executor* executor = nullptr) const;
  void any_hit(std::span<const Ray> rays, std::span<bool> hits, Executor* executor = nullptr) const;
  /// What rays[i] crosses is hits[offsets[i]] to hits[offsets[i + 1]], the end not included. Replaces what
  /// both hold.
  void all_hits(std::span<const Ray> rays, std::vector<std::size_t>& offsets, std::vector<Hit>& hits,
                Executor* executor = nullptr) const;
  void count_hits(std::span<const Ray> rays, std::span<std::size_t> counts,
                  Executor* executor = nullptr) const;

  /// As closest_hit, and adds up the work: boxes and shapes tested by plain C++, one ray at a time.
  Hit closest_hit(const Ray& ray, TraversalStatistics& statistics) const;

  /// The nearest point of any surface within `max_distance`; equal distance goes to the smallest ids.
  /// Throws std::invalid_argument for a scene with shapes other than triangles and quads under a transform
  /// that is not a similarity, and for AnyShape that knows no closest point.
  ScenePoint closest_point(Vec3 point, float max_distance = kInfinity) const;

  const SceneDesc& description() const;
  Box3 bounds() const;
  SceneStatistics statistics() const;

  struct Parts;  ///< The trees (scene/parts.h); for `boxwood info` and tests.
  const Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<const Parts> parts_;
};

}  // namespace boxwood
