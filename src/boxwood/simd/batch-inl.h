// batch-inl.h: how are many rays answered best? Compiled once for each instruction set.
//
// Rays that go the same way go as a bundle, all others take turns; where a tree is too deep for that, one
// after the other.

#if defined(BOXWOOD_SIMD_BATCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SIMD_BATCH_INL_H
#undef BOXWOOD_SIMD_BATCH_INL_H
#else
#define BOXWOOD_SIMD_BATCH_INL_H
#endif

#include <numeric>

#include "boxwood/simd/bundle-inl.h"
#include "boxwood/simd/interleave-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::simd::HWY_NAMESPACE {

/// What a batch says of a ray.
inline void write_found(const TriangleHit& hit, TriangleHit& found) {
  found = hit;
  if (!hit.is_hit()) found.t = kInfinity;
}
inline void write_found(const TriangleHit& hit, bool& found) {
  found = hit.is_hit();
}

/// Fetches the line of answers[i] for writing; any line where there are no answers.
HWY_INLINE void fetch_answer(const Hit* answers, std::size_t i) {
  __builtin_prefetch(reinterpret_cast<const void*>(std::uintptr_t(answers) + i * sizeof(Hit)), 1);
}

/// A thread's memory for the rays that it has in flight.
inline RayInFlight* rays_in_flight() {
  static thread_local const std::unique_ptr<RayInFlight[]> flight(new RayInFlight[kInFlight]);
  return flight.get();
}

/// found[i] answers rays[i], where the ray is ordinary; `unusual` gets the indices of the others. Found is
/// bool for any hit, TriangleHit for the closest, whose `answers` are fetched ahead.
template <class Layout, class Found>
void trace_batch(const TriangleTree& tree, std::span<const Ray> rays, const Box3& bounds, Found* found,
                 const Hit* answers, std::vector<std::uint32_t>& unusual) {
  constexpr bool kAny = std::is_same_v<Found, bool>;
  const auto output = [&](std::uint32_t i, const TriangleHit& hit) {
    write_found(hit, found[i]);
    if constexpr (!kAny) fetch_answer(answers, i);
  };
  const char* pool = tree.pool();
  constexpr std::size_t kAtOnce = 4096;
  HWY_ALIGN std::uint32_t order[kAtOnce];
  for (std::size_t begin = 0; begin < rays.size(); begin += kAtOnce) {
    // Trace bundles; note the rest.
    const std::size_t end = std::min(rays.size(), begin + kAtOnce);
    std::size_t count = 0, bundle_count = 0, bundle_begin[2];
    Bundle<Layout, kAny> bundles[2];
    const auto trace = [&] {
      trace_bundles(pool, std::span(bundles, bundle_count));
      for (std::size_t k = 0; k < bundle_count; ++k) {
        bundles[k].store(&found[bundle_begin[k]]);
        if constexpr (!kAny)
          for (std::size_t i = 0; i < kBundle; ++i) fetch_answer(answers, bundle_begin[k] + i);
      }
      bundle_count = 0;
    };
    for (std::size_t i = begin; i < end;) {
      const std::size_t group = std::min(end - i, std::size_t(kBundle));
      if (group == kBundle && may_be_bundle(&rays[i]) &&
          bundles[bundle_count].prepare(&rays[i], bounds, tree.box_slack())) {
        bundle_begin[bundle_count++] = i;
        if (bundle_count == 2) trace();
      } else {
        for (std::size_t k = 0; k < group; ++k) order[count++] = static_cast<std::uint32_t>(i + k);
      }
      i += group;
    }
    if (bundle_count > 0) trace();

    // The rest takes turns.
    const std::span<const std::uint32_t> rest(order, count);
    if (tree.max_stack() + kWidth <= kShortStack) {
      Interleaved<Layout, kAny ? Ask::any : Ask::closest, decltype(output)>(tree, bounds, rays.data(), rest,
                                                                            output, unusual)
          .run(rays_in_flight());
      continue;
    }
    for (const std::uint32_t i : rest) {
      KernelRay ray;
      if (!prepare(rays[i], bounds, tree.box_slack(), ray)) {
        unusual.push_back(i);
        continue;
      }
      TriangleHit hit{rays[i].t_max + 0.0f};
      if constexpr (kAny) {
        if (any_hit_one<Layout>(pool, ray, Direct{}, hit.t)) hit.block = 0;
      } else {
        EdgesOfHit edges;
        closest_hit_one<Layout>(pool, ray, Direct{}, hit, edges);
      }
      output(i, hit);
    }
  }
}

/// Appends every crossing of the rays that are ordinary to `found`, once for each block that its triangle
/// stands in; `unusual` gets the indices of the others.
template <class Layout>
void trace_all(const TriangleTree& tree, std::span<const Ray> rays, const Box3& bounds,
               std::vector<RayCrossing>& found, std::vector<std::uint32_t>& unusual) {
  if (tree.max_stack() + kWidth <= kShortStack) {
    struct Output {
      std::vector<RayCrossing>& found;
      void see(std::uint32_t ray_index, const TriangleHit& hit) const { found.push_back({hit, ray_index}); }
      void operator()(std::uint32_t, const TriangleHit&) const {}
    } output{found};
    constexpr std::size_t kAtOnce = 4096;
    std::uint32_t order[kAtOnce];
    for (std::size_t begin = 0; begin < rays.size(); begin += kAtOnce) {
      const std::size_t count = std::min(rays.size() - begin, kAtOnce);
      std::iota(order, order + count, static_cast<std::uint32_t>(begin));
      Interleaved<Layout, Ask::all, Output>(tree, bounds, rays.data(), std::span(order, count), output,
                                            unusual)
          .run(rays_in_flight());
    }
    return;
  }
  std::vector<TriangleHit> of_ray;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    KernelRay ray;
    if (!prepare(rays[i], bounds, tree.box_slack(), ray)) {
      unusual.push_back(index);
      continue;
    }
    of_ray.clear();
    all_hits_one<Layout>(tree.pool(), ray, Direct{}, rays[i].t_max + 0.0f, of_ray);
    for (const TriangleHit& hit : of_ray) found.push_back({hit, index});
  }
}

}  // namespace boxwood::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
