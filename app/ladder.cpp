#include "ladder.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>

#include <fmt/format.h>

#include "boxwood/core/error.h"
#include "boxwood/gallery/gallery.h"
#include "flat_shapes.h"
#include "ladder_rays.h"
#include "ladder_rungs.h"
#include "numbers.h"

namespace boxwood::app {
namespace {

constexpr double kRungSeconds = 1;      // to trace the scene's rays; brute force gets three times as much
constexpr double kPointSeconds = 0.12;  // to trace rays at one point of the growth
constexpr std::size_t kGrowthRays = 20'000, kFewestRays = 16;
constexpr std::size_t kCountedRays = 4'000;  // so that counts do not depend on the time

/// Time that this program had a processor for. Everything here runs on one thread, so on a machine of its own
/// it is the time on the wall; on a busy one it does not count what others do.
double seconds_now() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}
double seconds_since(double start) {
  return seconds_now() - start;
}

void tell(const Progress& progress, std::string_view stage, double done) {
  if (progress && !progress(stage, done)) throw Cancelled();
}

struct Timing {
  std::size_t rays = 0;  // so many were traced
  double ns_per_ray = 0;
};

/// Traces as many of `rays` as `seconds` allow, from the first, but at least `fewest`; and then the same
/// again while there is time. The fastest pass counts, because whatever else the machine does can only slow
/// one down.
template <class S>
Timing time_rays(const Rung<S>& rung, std::span<const Ray> rays, std::span<ShapeHit> hits, double seconds,
                 std::size_t fewest) {
  Timing timing;
  const double start = seconds_now();
  double spent = 0;
  while (timing.rays < rays.size()) {
    // Batches grow with what is known of the speed.
    const double affordable =
        timing.rays > 0 ? (seconds - spent) * double(timing.rays) / spent : double(kFewestRays);
    if (timing.rays >= fewest && affordable < 1) break;
    const double most = double(std::max(kFewestRays, 4 * timing.rays));
    const auto batch = static_cast<std::size_t>(std::clamp(affordable, 1.0, most));
    const std::size_t count = std::min(batch, rays.size() - timing.rays);
    rung.trace(rays.subspan(timing.rays, count), hits.subspan(timing.rays, count));
    timing.rays += count;
    spent = seconds_since(start);
  }
  double fastest = spent;
  for (int again = 0; again < 3 && seconds_since(start) + fastest < seconds; ++again) {
    const double pass = seconds_now();
    rung.trace(rays.first(timing.rays), hits.first(timing.rays));
    fastest = std::min(fastest, seconds_since(pass));
  }
  timing.ns_per_ray = 1e9 * fastest / double(timing.rays);
  return timing;
}

/// Where a ray hits first, by a tree that is built for it.
template <class S>
std::vector<Ray> make_rays(const std::vector<S>& shapes, const SceneDesc& scene, std::size_t count) {
  const Bvh bvh = build(boxes(shapes), {.executor = &serial_executor()});
  return ladder_rays(bvh.bounds(), scene.camera, count,
                     [&](const Ray& ray) { return closest_hit(bvh, shapes, ray).t; });
}

/// All rungs over one scene.
template <class S>
void climb_scene(const std::vector<S>& shapes, std::span<const Ray> rays, const Progress& progress,
                 LadderReport& report) {
  std::vector<ShapeHit> truth(rays.size()), hits(rays.size());
  const auto recipes = rung_recipes<S>();
  // truth[0, known) is filled: by brute force, and beyond its rays by the first to come that far.
  std::size_t known = 0;
  for (std::size_t r = 0; r < recipes.size(); ++r) {
    tell(progress, "rungs", double(r) / double(recipes.size()));
    const bool is_brute_force = r == 0;
    RungReport rung{.name = recipes[r].name};

    const double start = seconds_now();
    const auto built = recipes[r].build(shapes);
    rung.build_ms = 1e3 * seconds_since(start);
    rung.bytes_per_primitive = double(built->size_bytes()) / double(shapes.size());

    const Timing timing = is_brute_force
                              ? time_rays(*built, rays, hits, 3 * kRungSeconds, kFewestRays)
                              : time_rays(*built, rays, hits, kRungSeconds, report.brute_force_rays);
    rung.mrays_per_s = 1e3 / timing.ns_per_ray;
    if (is_brute_force) report.brute_force_rays = timing.rays;

    // Compare with brute force, and beyond its rays with the rungs before.
    for (std::size_t i = 0; i < std::min(known, timing.rays); ++i)
      rung.agrees = rung.agrees && hits[i] == truth[i];
    for (; known < timing.rays; ++known) truth[known] = hits[known];

    const std::size_t counted = std::min(kCountedRays, rays.size());
    reference::RivalStatistics statistics;
    built->count(rays.first(counted), statistics);
    const auto per_ray = [&](std::uint64_t count) { return double(count) / double(counted); };
    rung.box_tests_per_ray = per_ray(statistics.box_tests);
    rung.shape_tests_per_ray = per_ray(statistics.shape_tests);
    rung.repeated_tests_per_ray = per_ray(statistics.repeated_tests);
    report.rungs.push_back(rung);
  }
}

/// What is known of one rung while scenes grow.
struct Grower {
  GrowthReport report;
  double build_seconds = 0;
};

/// Why the next point, of `n` primitives, is left out; empty when it is not.
std::string reason_to_stop(const Grower& grower, std::size_t n, double seconds_per_point) {
  if (!grower.report.stopped.empty()) return grower.report.stopped;
  if (grower.report.points.empty()) return {};
  const GrowthPoint& last = grower.report.points.back();
  const double ratio = double(n) / double(last.n);
  const double tracing = std::max(kPointSeconds, 1e-9 * last.ns_per_ray * ratio * double(kFewestRays));
  const double seconds = grower.build_seconds * ratio * 1.1 + tracing;
  if (seconds <= seconds_per_point) return {};
  return fmt::format("stopped before {}, which would take about {:.0f} s", with_commas(n), seconds);
}

/// Adds a point to each rung that still takes part.
template <class S>
void grow_to(const std::vector<S>& shapes, std::span<const Ray> rays, double seconds_per_point,
             const std::function<void(double)>& tell_done, std::vector<Grower>& growers) {
  const auto recipes = rung_recipes<S>();
  growers.resize(recipes.size());
  std::vector<ShapeHit> hits(rays.size());
  for (std::size_t r = 0; r < recipes.size(); ++r) {
    tell_done(double(r) / double(recipes.size()));
    Grower& grower = growers[r];
    grower.report.rung = recipes[r].name;
    grower.report.stopped = reason_to_stop(grower, shapes.size(), seconds_per_point);
    if (!grower.report.stopped.empty()) continue;

    const double start = seconds_now();
    const auto built = recipes[r].build(shapes);
    grower.build_seconds = seconds_since(start);
    const Timing timing = time_rays(*built, rays, hits, kPointSeconds, kFewestRays);
    reference::RivalStatistics statistics;
    built->count(rays.first(kCountedRays), statistics);
    const double tests = double(statistics.box_tests + statistics.shape_tests) / double(kCountedRays);
    grower.report.points.push_back({shapes.size(), tests, timing.ns_per_ray});
  }
}

std::vector<GrowthReport> fitted(const std::vector<Grower>& growers) {
  std::vector<GrowthReport> reports;
  for (const Grower& grower : growers) {
    GrowthReport report = grower.report;
    std::vector<std::pair<double, double>> tests, times;
    for (const GrowthPoint& point : report.points) {
      tests.emplace_back(double(point.n), point.tests_per_ray);
      times.emplace_back(double(point.n), point.ns_per_ray);
    }
    report.exponent = fit_exponent(tests);
    report.time_exponent = fit_exponent(times);
    reports.push_back(report);
  }
  return reports;
}

/// Climbs over family:n for each of `sizes`.
template <class MakeRays>
std::vector<GrowthReport> grow(const std::string& family, const std::vector<std::size_t>& sizes,
                               std::string_view stage, const LadderOptions& options, const Progress& progress,
                               const MakeRays& make_rays_for) {
  std::vector<Grower> growers;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    // Time grows with the size; the bar runs by the place in the list, weighted towards the end.
    const auto share = [&](std::size_t k) { return std::pow(double(k) / double(sizes.size()), 3.0); };
    const auto tell_done = [&](double part) {
      tell(progress, stage, share(i) + part * (share(i + 1) - share(i)));
    };
    tell_done(0);
    const SceneDesc scene = gallery::make(family + ":" + std::to_string(sizes[i]));
    std::visit(
        [&](const auto& shapes) {
          grow_to(shapes, make_rays_for(shapes, scene), options.seconds_per_point, tell_done, growers);
        },
        flatten(scene));
  }
  return fitted(growers);
}

/// The family of scenes that `name` belongs to,
/// where its size is the number of primitives; else random triangles.
std::string growth_family(const std::string& name) {
  const std::string family = name.substr(0, name.find(':'));
  return family == "spheres" ? family : "soup";
}

}  // namespace

LadderReport climb(const std::string& name, const SceneDesc& scene, const LadderOptions& options,
                   const Progress& progress) {
  LadderReport report{.scene = name};
  const FlatShapes flat = flatten(scene);
  report.kind = kind_name(flat);
  report.primitives = shape_count(flat);
  report.rays = options.rays;
  if (report.primitives == 0)
    throw std::invalid_argument(name + ": there is nothing in it that a ray could hit");

  std::visit(
      [&](const auto& shapes) {
        climb_scene(shapes, make_rays(shapes, scene, options.rays), progress, report);
      },
      flat);

  report.growth_family = growth_family(name);
  report.growth =
      grow(report.growth_family, options.growth_sizes, "growth", options, progress,
           [](const auto& shapes, const SceneDesc& s) { return make_rays(shapes, s, kGrowthRays); });
  report.worst_case = grow("duplicates", options.worst_case_sizes, "worst case", options, progress,
                           [](const auto& shapes, const SceneDesc&) {
                             if constexpr (std::is_same_v<std::decay_t<decltype(shapes[0])>, Triangle>)
                               return rays_at(shapes[0], kGrowthRays);
                             else
                               return std::vector<Ray>{};
                           });
  return report;
}

double fit_exponent(const std::vector<std::pair<double, double>>& points) {
  double mean_x = 0, mean_y = 0;
  for (const auto& [x, y] : points) {
    mean_x += std::log(x) / double(points.size());
    mean_y += std::log(y) / double(points.size());
  }
  double xy = 0, xx = 0;
  for (const auto& [x, y] : points) {
    xy += (std::log(x) - mean_x) * (std::log(y) - mean_y);
    xx += (std::log(x) - mean_x) * (std::log(x) - mean_x);
  }
  return xx > 0 ? xy / xx : 0;
}

}  // namespace boxwood::app
