// kernels.h: the door to the SIMD kernels. Ordinary C++: nothing of what is behind it shows.
//
// The algorithms (the *-inl.h files of this room) are written once and compiled for each instruction set;
// here one is picked at run time. All give the same answers, bit for bit: those of shape/triangle.h under
// shape/gate.h by brute force.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "boxwood/core/hit.h"
#include "boxwood/core/prepared_ray.h"
#include "boxwood/simd/placed_trees.h"

namespace boxwood::simd {

/// What a kernel found, by its place in the tree. A miss has no block and t = +inf.
struct TriangleHit {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  float t = kInfinity;
  std::uint32_t key = kNone;    ///< TriangleBlock::key of the triangle.
  std::uint32_t block = kNone;  ///< For TriangleTree::triangle().
  std::uint32_t lane = 0;       ///< In its block.

  bool is_hit() const { return block != kNone; }
};

/// One of the crossings of a batch, and whose it is.
struct RayCrossing {
  TriangleHit hit;
  std::uint32_t ray_index;
};

/// A TriangleHit below a placement, of which `item` is the number and `instance` the name (PlacedTree). Where
/// nothing below a placement has been hit, t is the limit, and an equal t counts below `instance` only.
struct PlacedHit : TriangleHit {
  std::uint32_t item = kNone, instance = kNone;

  bool is_placed() const { return item != kNone; }
};

/// The point of a triangle that is nearest to a given one. None: no block, and distance = +inf.
struct TrianglePoint {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  float distance = kInfinity;
  Vec3 position;
  std::uint32_t key = kNone;    ///< TriangleBlock::key of the triangle.
  std::uint32_t block = kNone;  ///< Where it stands; also where to look first (Kernels::closest_point).

  bool is_found() const { return block != kNone; }
};

/// What stands between the triangles below a placement and the answer: t is moved into `inside`, which is
/// what the ray has inside the placement's world box, and counts when it is at least t_min then
/// (shape/gate.h).
struct Passage {
  Interval inside;
  float t_min;
};

/// Looks at an item of a BoxTree; returns how far, in t, others still matter.
using VisitItem = float (*)(void* context, std::uint32_t item);

/// The kernels of one instruction set.
///
/// `bounds` are those that a PreparedRay would be made with: of the whole scene. Kernels take ordinary rays
/// (of finite numbers, with t_min <= t_max, and of a size at which no float overflows on the way); any other
/// ray is handed back for plain C++ to answer: single-ray calls return false and leave the answer alone,
/// batches note the ray's index. Preconditions: tree.width() == width, tree.is_ordinary(), and the tree is
/// not empty. Any number of threads may call. No call allocates, but for what it appends to vectors, and for
/// the rays that a batch has in flight (40 kB, and 68 kB where it goes below placements; 76 and 117 kB with
/// sixteen children): once for each thread.
struct Kernels {
  std::string_view name;  ///< "avx512", "avx2", "sse4", "neon", "wasm".
  int width;              ///< Children of a node in the trees that these kernels walk.

  /// The crossing of smallest t in [t_min, t_max], equal t by key.
  bool (*closest_hit)(const TriangleTree& tree, const Ray& ray, const Box3& bounds, TriangleHit& hit);
  /// The same, and what finish_hits says of it in `full`, which is a miss before.
  bool (*closest_full_hit)(const TriangleTree& tree, const Ray& ray, const Box3& bounds, TriangleHit& hit,
                           Hit& full);
  /// Whether there is a crossing in [t_min, t_max].
  bool (*any_hit)(const TriangleTree& tree, const Ray& ray, const Box3& bounds, bool& is_hit);
  /// Appends every crossing in [t_min, t_max] once for each block that its triangle stands in; in no order.
  bool (*all_hits)(const TriangleTree& tree, const Ray& ray, const Box3& bounds,
                   std::vector<TriangleHit>& hits);

  /// The same for a ray in object space, below a placement, whose t_min may be negative or -inf; `bounds` are
  /// those of the object, t_max is the world's, and so are the answers.
  bool (*placed_all_hits)(const TriangleTree& tree, const Ray& ray, const Box3& bounds,
                          const Passage& passage, float t_max, std::vector<TriangleHit>& hits);

  /// Calls visit(context, item) for every item of the tree whose box the ray enters before a limit, nearest
  /// boxes first: ray.t_max at the beginning, then what visit() returned last, which must not grow.
  bool (*visit_boxes)(const BoxTree& tree, const Ray& ray, const Box3& bounds, VisitItem visit,
                      void* context);

  /// As closest_hit and any_hit for many rays, on the calling thread: hits[i] answers rays[i]. The indices of
  /// rays that are not ordinary are appended to `unusual`. Memory at `answers`, where finish_hits will write,
  /// is fetched ahead as rays end, and left alone; may be null.
  void (*closest_hits)(const TriangleTree& tree, std::span<const Ray> rays, const Box3& bounds,
                       TriangleHit* hits, const Hit* answers, std::vector<std::uint32_t>& unusual);
  void (*any_hits)(const TriangleTree& tree, std::span<const Ray> rays, const Box3& bounds, bool* hits,
                   std::vector<std::uint32_t>& unusual);

  /// As all_hits for many rays: appends every crossing to `found`, in no order.
  void (*all_hits_of)(const TriangleTree& tree, std::span<const Ray> rays, const Box3& bounds,
                      std::vector<RayCrossing>& found, std::vector<std::uint32_t>& unusual);

  /// Fills hits[i] with t, u, v and the normal of what closest_hits found for rays[i], or with a miss; ids
  /// are left to the caller.
  void (*finish_hits)(const TriangleTree& tree, std::span<const Ray> rays, const TriangleHit* found,
                      Hit* hits);

  /// The first crossing of a triangle below a placement that comes before `hit`, equal t by (instance, key):
  /// t counts as far as hit.t, and equal to that for instances below hit.instance. Fills `full`, but for the
  /// ids, when there is one. `bounds` are the world's. Precondition, here and below: trees.is_ordinary(), and
  /// they have triangles. False also for a ray that is not ordinary in the space of an object.
  bool (*closest_hit_below)(const PlacedTrees& trees, const Ray& ray, const Box3& bounds, PlacedHit& hit,
                            Hit& full);
  bool (*any_hit_below)(const PlacedTrees& trees, const Ray& ray, const Box3& bounds, bool& is_hit);
  /// The same for the rays of which `order` has the indices: hits[i] belongs to rays[i], and is left alone
  /// for rays whose indices are appended to `unusual`. `answers` as for closest_hits.
  void (*closest_hits_below)(const PlacedTrees& trees, std::span<const Ray> rays, const Box3& bounds,
                             std::span<const std::uint32_t> order, PlacedHit* hits, const Hit* answers,
                             std::vector<std::uint32_t>& unusual);
  void (*any_hits_below)(const PlacedTrees& trees, std::span<const Ray> rays, const Box3& bounds,
                         std::span<const std::uint32_t> order, bool* hits,
                         std::vector<std::uint32_t>& unusual);
  /// As finish_hits, for each hit that is_placed(); others are left alone.
  void (*finish_hits_below)(const PlacedTrees& trees, std::span<const Ray> rays, const PlacedHit* found,
                            Hit* hits);

  /// The point of a triangle within `max_distance` that is nearest to `point`, equal distance by key: that of
  /// query/distance.h by brute force. `nearest.block` says where to look first, for instance at what the
  /// point before was nearest to, and shows in the time only. False, and nothing is touched, for a point that
  /// is not finite or beyond kLargestReach; `max_distance` must be at least 0.
  bool (*closest_point)(const TriangleTree& tree, Vec3 point, float max_distance, TrianglePoint& nearest);
};

/// Every set of kernels that this program has and this machine can run, the fastest first. May be empty: then
/// plain C++ answers everything.
std::span<const Kernels* const> available_kernels();

/// The fastest of them, or the one that the environment variable BOXWOOD_TARGET names; null for "scalar", and
/// where there is none. Throws std::invalid_argument when BOXWOOD_TARGET names something else. Reads the
/// environment once.
const Kernels* kernels();

}  // namespace boxwood::simd
