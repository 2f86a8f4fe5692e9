#include "boxwood/simd/kernels.h"

// Compile what follows once for each instruction set that the compiler knows.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "boxwood/simd/kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first
#include <hwy/highway.h>

#include "boxwood/simd/batch-inl.h"
#include "boxwood/simd/boxes-inl.h"
#include "boxwood/simd/closest_point-inl.h"
#include "boxwood/simd/finish-inl.h"
#include "boxwood/simd/placed_batch-inl.h"
#include "boxwood/simd/placed_finish-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

/// The kernels of one layout.
template <class Layout>
struct KernelsFor {
  static bool closest_hit(const TriangleTree& tree, const Ray& ray, const Box3& bounds, TriangleHit& hit) {
    KernelRay kernel_ray;
    if (!prepare(ray, bounds, tree.box_slack(), kernel_ray)) return false;
    hit = {ray.t_max + 0.0f};
    EdgesOfHit edges;
    closest_hit_one<Layout>(tree.pool(), kernel_ray, Direct{}, hit, edges);
    if (!hit.is_hit()) hit.t = kInfinity;
    return true;
  }

  static bool closest_full_hit(const TriangleTree& tree, const Ray& ray, const Box3& bounds, TriangleHit& hit,
                               Hit& full) {
    KernelRay kernel_ray;
    if (!prepare(ray, bounds, tree.box_slack(), kernel_ray)) return false;
    hit = {ray.t_max + 0.0f};
    EdgesOfHit edges;
    closest_hit_one<Layout>(tree.pool(), kernel_ray, Direct{}, hit, edges);
    if (hit.is_hit())
      finish_one<Layout>(tree, kernel_ray, hit, edges, full);
    else
      hit.t = kInfinity;
    return true;
  }

  static bool any_hit(const TriangleTree& tree, const Ray& ray, const Box3& bounds, bool& is_hit) {
    KernelRay kernel_ray;
    if (!prepare(ray, bounds, tree.box_slack(), kernel_ray)) return false;
    is_hit = any_hit_one<Layout>(tree.pool(), kernel_ray, Direct{}, ray.t_max + 0.0f);
    return true;
  }

  static bool all_hits(const TriangleTree& tree, const Ray& ray, const Box3& bounds,
                       std::vector<TriangleHit>& hits) {
    KernelRay kernel_ray;
    if (!prepare(ray, bounds, tree.box_slack(), kernel_ray)) return false;
    all_hits_one<Layout>(tree.pool(), kernel_ray, Direct{}, ray.t_max + 0.0f, hits);
    return true;
  }

  static bool placed_all_hits(const TriangleTree& tree, const Ray& ray, const Box3& bounds,
                              const Passage& passage, float t_max, std::vector<TriangleHit>& hits) {
    KernelRay kernel_ray;
    if (!prepare<true>(ray, bounds, tree.box_slack(), kernel_ray)) return false;
    all_hits_one<Layout>(tree.pool(), kernel_ray, Moved{passage}, t_max + 0.0f, hits);
    return true;
  }

  static void closest_hits(const TriangleTree& tree, std::span<const Ray> rays, const Box3& bounds,
                           TriangleHit* hits, const Hit* answers, std::vector<std::uint32_t>& unusual) {
    trace_batch<Layout>(tree, rays, bounds, hits, answers, unusual);
  }

  static void any_hits(const TriangleTree& tree, std::span<const Ray> rays, const Box3& bounds, bool* hits,
                       std::vector<std::uint32_t>& unusual) {
    trace_batch<Layout>(tree, rays, bounds, hits, nullptr, unusual);
  }

  static void all_hits_of(const TriangleTree& tree, std::span<const Ray> rays, const Box3& bounds,
                          std::vector<RayCrossing>& found, std::vector<std::uint32_t>& unusual) {
    trace_all<Layout>(tree, rays, bounds, found, unusual);
  }

  static void finish_hits(const TriangleTree& tree, std::span<const Ray> rays, const TriangleHit* found,
                          Hit* hits) {
    finish_all<Layout>(tree, rays, found, hits);
  }

  static bool closest_hit_below(const PlacedTrees& trees, const Ray& ray, const Box3& bounds, PlacedHit& hit,
                                Hit& full) {
    KernelRay world;
    if (!prepare(ray, bounds, BoxTree::kSlack, world)) return false;
    PlacedWalk<Layout> walk(trees, ray, world, hit);
    if (!walk.run()) return false;
    hit = walk.hit;
    if (hit.is_placed()) finish_one_placed<Layout>(trees, walk, full);
    return true;
  }

  static bool any_hit_below(const PlacedTrees& trees, const Ray& ray, const Box3& bounds, bool& is_hit) {
    KernelRay world;
    if (!prepare(ray, bounds, BoxTree::kSlack, world)) return false;
    PlacedSearch<Layout> search{trees, ray, world, ray.t_max + 0.0f};
    if (!search.run()) return false;
    is_hit = search.is_hit;
    return true;
  }

  static void closest_hits_below(const PlacedTrees& trees, std::span<const Ray> rays, const Box3& bounds,
                                 std::span<const std::uint32_t> order, PlacedHit* hits, const Hit* answers,
                                 std::vector<std::uint32_t>& unusual) {
    trace_placed<Layout, false>(trees, bounds, rays.data(), order, ClosestPlaced{hits, answers}, unusual);
  }

  static void any_hits_below(const PlacedTrees& trees, std::span<const Ray> rays, const Box3& bounds,
                             std::span<const std::uint32_t> order, bool* hits,
                             std::vector<std::uint32_t>& unusual) {
    trace_placed<Layout, true>(trees, bounds, rays.data(), order, AnyPlaced{rays.data(), hits}, unusual);
  }

  static void finish_hits_below(const PlacedTrees& trees, std::span<const Ray> rays, const PlacedHit* found,
                                Hit* hits) {
    finish_all_placed<Layout>(trees, rays, found, hits);
  }

  static bool closest_point(const TriangleTree& tree, Vec3 point, float max_distance,
                            TrianglePoint& nearest) {
    if (!is_ordinary_point(point)) return false;
    nearest.distance = max_distance;
    closest_point_one<Layout>(tree, point, nearest);
    if (!nearest.is_found()) nearest.distance = kInfinity;
    return true;
  }
};

/// Asks the kernel of the tree's layout.
template <auto kFull, auto kCompact>
struct Either;
template <class Result, class Tree, class... Args, Result (*kFull)(const Tree&, Args...),
          Result (*kCompact)(const Tree&, Args...)>
struct Either<kFull, kCompact> {
  static Result ask(const Tree& tree, Args... args) {
    return tree.layout() == Layout::full ? kFull(tree, args...) : kCompact(tree, args...);
  }
};
using Full = KernelsFor<FullLayout>;
using Compact = KernelsFor<CompactLayout>;

bool visit_boxes(const BoxTree& tree, const Ray& ray, const Box3& bounds, VisitItem visit, void* context) {
  KernelRay kernel_ray;
  if (!prepare(ray, bounds, BoxTree::kSlack, kernel_ray)) return false;
  struct Caller {
    VisitItem call;
    void* context;
    float visit(std::uint32_t item) const { return call(context, item); }
  } caller{visit, context};
  visit_boxes_one(tree.pool(), 0, kernel_ray, ray.t_max + 0.0f, caller);
  return true;
}

constexpr std::string_view target_name() {
  switch (HWY_TARGET) {
    case HWY_AVX3:
      return "avx512";
    case HWY_AVX2:
      return "avx2";
    case HWY_SSE4:
      return "sse4";
    case HWY_NEON:
      return "neon";
    case HWY_WASM:
      return "wasm";
    default:
      return "other";
  }
}

const Kernels* table() {
  static constexpr Kernels kTable{target_name(),
                                  kWidth,
                                  Either<Full::closest_hit, Compact::closest_hit>::ask,
                                  Either<Full::closest_full_hit, Compact::closest_full_hit>::ask,
                                  Either<Full::any_hit, Compact::any_hit>::ask,
                                  Either<Full::all_hits, Compact::all_hits>::ask,
                                  Either<Full::placed_all_hits, Compact::placed_all_hits>::ask,
                                  visit_boxes,
                                  Either<Full::closest_hits, Compact::closest_hits>::ask,
                                  Either<Full::any_hits, Compact::any_hits>::ask,
                                  Either<Full::all_hits_of, Compact::all_hits_of>::ask,
                                  Either<Full::finish_hits, Compact::finish_hits>::ask,
                                  Either<Full::closest_hit_below, Compact::closest_hit_below>::ask,
                                  Either<Full::any_hit_below, Compact::any_hit_below>::ask,
                                  Either<Full::closest_hits_below, Compact::closest_hits_below>::ask,
                                  Either<Full::any_hits_below, Compact::any_hits_below>::ask,
                                  Either<Full::finish_hits_below, Compact::finish_hits_below>::ask,
                                  Either<Full::closest_point, Compact::closest_point>::ask};
  return &kTable;
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace boxwood::simd {

std::span<const Kernels* const> available_kernels() {
  // Asked by name, and not by Highway's own dispatch, whose choice belongs to the whole program.
  static const std::vector<const Kernels*> all = [] {
#if HWY_ARCH_WASM
    const std::int64_t supported = HWY_WASM;  // or the module would not have been loaded
#else
    const std::int64_t supported = hwy::SupportedTargets();
#endif
    std::vector<const Kernels*> found;
    const auto add = [&](std::int64_t target, const Kernels* kernels) {
      if (supported & target) found.push_back(kernels);
    };
#if HWY_TARGETS & HWY_AVX3
    add(HWY_AVX3, N_AVX3::table());
#endif
#if HWY_TARGETS & HWY_AVX2
    add(HWY_AVX2, N_AVX2::table());
#endif
#if HWY_TARGETS & HWY_SSE4
    add(HWY_SSE4, N_SSE4::table());
#endif
#if HWY_TARGETS & HWY_NEON
    add(HWY_NEON, N_NEON::table());
#endif
#if HWY_TARGETS & HWY_WASM
    add(HWY_WASM, N_WASM::table());
#endif
    return found;
  }();
  return all;
}

const Kernels* kernels() {
  static const Kernels* const chosen = []() -> const Kernels* {
    const char* name = std::getenv("BOXWOOD_TARGET");
    const auto all = available_kernels();
    if (name == nullptr || *name == 0) return all.empty() ? nullptr : all.front();
    std::string known = "scalar";
    for (const Kernels* k : all) {
      if (k->name == name) return k;
      known = std::string(k->name) + ", " + known;
    }
    if (std::string_view(name) == "scalar") return nullptr;
    throw std::invalid_argument("BOXWOOD_TARGET is \"" + std::string(name) + "\"; this machine has " + known);
  }();
  return chosen;
}

}  // namespace boxwood::simd
#endif
