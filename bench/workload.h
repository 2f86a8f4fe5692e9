// workload.h: on what is everything measured?
//
// Every benchmark asks the same rays of the same shapes, so that rates can be compared, and reports how many
// rays hit and the sum of the distances, so that a fast wrong answer shows.
#pragma once

#include <vector>

#include <benchmark/benchmark.h>

#include "boxwood/scene/description.h"
#include "boxwood/shape/triangle.h"

namespace boxwood::bench {

/// The triangles of a scene of the gallery, in world space, made once.
const std::vector<Triangle>& triangles(const char* scene);

/// The spheres of "spheres:100000".
const std::vector<Sphere>& spheres();

/// Half of the rays start outside of `bounds` and aim into it, as a camera's do; half start inside and go
/// anywhere, as those of reflected light do.
std::vector<Ray> mixed_rays(const Box3& bounds, std::size_t count);

/// Shadow rays: from one point inside `bounds` to another.
std::vector<Ray> shadow_rays(const Box3& bounds, std::size_t count);

inline constexpr std::size_t kRays = 1 << 16;

/// Reports how many of `count` rays hit, and the sum of t_of(i). A miss is +inf.
template <class TOf>
void report_hits(benchmark::State& state, std::size_t count, const TOf& t_of) {
  std::size_t hits = 0;
  double checksum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float t = t_of(i);
    if (!(t < kInfinity)) continue;
    ++hits;
    checksum += t;
  }
  state.counters["hits"] = static_cast<double>(hits);
  state.counters["checksum"] = checksum;
}

/// Asks `answer(ray)` for the t of each ray, round after round, and counts rays. A miss is +inf.
template <class Answer>
void measure_rays(benchmark::State& state, const std::vector<Ray>& rays, const Answer& answer) {
  for (auto _ : state)
    for (const Ray& ray : rays) benchmark::DoNotOptimize(answer(ray));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * rays.size()));
  report_hits(state, rays.size(), [&](std::size_t i) { return answer(rays[i]); });
}

}  // namespace boxwood::bench
