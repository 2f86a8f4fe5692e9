// ladder.h: what does each step from brute force to the fastest kernel bring, in numbers?
//
// One scene, one set of rays, and one structure after the other: built, timed, counted, and compared with
// brute force ray by ray. Then the same over scenes from a hundred to eight million primitives, and the power
// of N that fits the work and the time of each. All on one thread, so that rungs differ in nothing but the
// algorithm.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "boxwood/core/progress.h"
#include "boxwood/scene/description.h"

namespace boxwood::app {

struct LadderOptions {
  std::size_t rays = 100'000;  ///< In the scene's set; at least 1.
  std::vector<std::size_t> growth_sizes = {100,    320,     1'000,   3'200,     10'000,
                                           32'000, 100'000, 320'000, 1'000'000, 8'000'000};
  std::vector<std::size_t> worst_case_sizes = {100, 1'000, 10'000};
  double seconds_per_point = 8;  ///< A rung of the growth stops before a point that would take longer.
};

/// One structure over the scene.
struct RungReport {
  std::string name;
  double build_ms = 0;
  double mrays_per_s = 0;
  double box_tests_per_ray = 0;
  double shape_tests_per_ray = 0;
  /// Of shape_tests_per_ray: of a shape that the same ray had tested before.
  double repeated_tests_per_ray = 0;
  double bytes_per_primitive = 0;  ///< What the structure adds to the shapes.
  bool agrees = true;              ///< With brute force, to the bit, on every ray that brute force traced.
};

struct GrowthPoint {
  std::size_t n = 0;         ///< Primitives.
  double tests_per_ray = 0;  ///< Boxes and shapes.
  double ns_per_ray = 0;
};

/// One structure over scenes of growing size.
struct GrowthReport {
  std::string rung;
  double exponent = 0;       ///< tests_per_ray grows as n to this power, by least squares over logarithms.
  double time_exponent = 0;  ///< The same for ns_per_ray.
  std::vector<GrowthPoint> points;
  std::string stopped;  ///< Why there are no more points; empty when the last size was reached.
};

struct LadderReport {
  std::string scene;
  std::string kind;  ///< Of the primitives: "triangles", ...
  std::size_t primitives = 0;
  std::size_t rays = 0;
  /// The first so many of them; fewer than `rays` where all would take too long.
  std::size_t brute_force_rays = 0;
  std::vector<RungReport> rungs;
  std::string growth_family;  ///< "soup": the scenes were soup:100, soup:320, ...
  std::vector<GrowthReport> growth;
  std::vector<GrowthReport> worst_case;  ///< Over duplicates:N, with rays that all hit.
};

/// Climbs the ladder over `scene`, which is called `name`. `progress` is told how far it is; when it returns
/// false, Cancelled is thrown. Throws std::invalid_argument when the scene has no primitives, or cannot be
/// used.
LadderReport climb(const std::string& name, const SceneDesc& scene, const LadderOptions& options,
                   const Progress& progress);

/// The slope of the line through (log x, log y) with the least squared error;
/// 0 with fewer than two different x.
double fit_exponent(const std::vector<std::pair<double, double>>& points);

}  // namespace boxwood::app
