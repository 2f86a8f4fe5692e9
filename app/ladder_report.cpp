#include "ladder_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "chart.h"
#include "numbers.h"
#include "table.h"

namespace boxwood::app {
namespace {

/// As many digits as tell something: 0, 0.05, 4.92, 35.7, 1,234.
std::string compact(double value) {
  const double size = std::fabs(value);
  return with_commas(value, size == 0 || size >= 100 ? 0 : size >= 10 ? 1 : 2);
}

/// Nanoseconds in a unit that fits: 87 ns, 1.24 µs.
std::string duration(double ns) {
  static const char* const kUnits[] = {"ns", "µs", "ms", "s"};
  int unit = 0;
  while (ns >= 999.5 && unit < 3) ns /= 1000, ++unit;
  return fmt::format("{:.{}f} {}", ns, ns >= 99.5 || unit == 0 ? 0 : ns >= 9.95 ? 1 : 2, kUnits[unit]);
}

std::string rung_table(const LadderReport& report) {
  Table table({"rung", "build ms", "Mrays/s", "speed-up", "boxes", "shapes", "repeated", "bytes", "agrees"});
  for (const RungReport& rung : report.rungs)
    table.add({rung.name, with_commas(rung.build_ms, 1),
               fmt::format("{:.{}f}", rung.mrays_per_s, rung.mrays_per_s < 0.1 ? 5 : 3),
               compact(rung.mrays_per_s / report.rungs[0].mrays_per_s) + " x",
               compact(rung.box_tests_per_ray), compact(rung.shape_tests_per_ray),
               compact(rung.repeated_tests_per_ray), compact(rung.bytes_per_primitive),
               rung.agrees ? "yes" : "NO"});
  return table.text();
}

std::string growth_table(const std::vector<GrowthReport>& growth) {
  std::vector<std::size_t> sizes;
  for (const GrowthReport& rung : growth)
    for (const GrowthPoint& point : rung.points) sizes.push_back(point.n);
  if (sizes.empty()) return {};
  const auto [smallest, largest] = std::minmax_element(sizes.begin(), sizes.end());

  Table table({"rung", "tests ~ N^", "time ~ N^", "tests at " + with_commas(*smallest),
               "at " + with_commas(*largest), "time at " + with_commas(*smallest),
               "at " + with_commas(*largest)});
  for (const GrowthReport& rung : growth) {
    if (rung.points.empty()) continue;
    const GrowthPoint &first = rung.points.front(), &last = rung.points.back();
    const bool is_whole = last.n == *largest;
    table.add({rung.rung, fmt::format("{:.2f}", rung.exponent), fmt::format("{:.2f}", rung.time_exponent),
               compact(first.tests_per_ray), is_whole ? compact(last.tests_per_ray) : "-",
               duration(first.ns_per_ray), is_whole ? duration(last.ns_per_ray) : "-"});
  }
  std::string text = table.text();
  for (const GrowthReport& rung : growth)
    if (!rung.stopped.empty()) text += fmt::format("  {}: {}\n", rung.rung, rung.stopped);
  return text;
}

const GrowthReport* find(const std::vector<GrowthReport>& growth, std::string_view rung) {
  for (const GrowthReport& report : growth)
    if (report.rung == rung && report.points.size() > 1) return &report;
  return nullptr;
}

/// What the seed claims, and what came out.
std::string growth_words(const LadderReport& report) {
  std::string text;
  const GrowthReport *brute = find(report.growth, "brute force"), *sah = find(report.growth, "sweep SAH");
  if (!brute || !sah) return text;
  const double surplus = sah->time_exponent - sah->exponent;
  const double ratio = double(sah->points.back().n) / double(sah->points.front().n);
  text += fmt::format("  Work grows as N^{:.2f} for brute force, as N^{:.2f} for sweep SAH.\n",
                      brute->exponent, sah->exponent);
  text += fmt::format(
      "  Time grows as N^{:.2f} for sweep SAH. The surplus, N^{:.2f}, is what the caches add: a test among\n"
      "  {} primitives, whose tree lies in memory, costs {:.1f} times one among {}.\n"
      "  Brute force reads its shapes in a row, which caches foresee: N^{:.2f}.\n",
      sah->time_exponent, surplus, with_commas(sah->points.back().n), std::pow(ratio, surplus),
      with_commas(sah->points.front().n), brute->time_exponent);
  return text;
}

}  // namespace

std::string ladder_table(const LadderReport& report) {
  std::string text = fmt::format("{}: {} {}, {} rays on one thread\n", report.scene,
                                 with_commas(report.primitives), report.kind, with_commas(report.rays));
  text +=
      "  Half of the rays come from the camera; the others leave, in random directions, where such rays "
      "hit.\n";
  text +=
      report.brute_force_rays < report.rays
          ? fmt::format(
                "  Brute force traced the first {} of them; all rungs are compared with it on these, and\n"
                "  with each other beyond.\n",
                with_commas(report.brute_force_rays))
          : "  All rungs are compared with brute force on all of them.\n";
  text += "\n" + rung_table(report);
  text +=
      "  boxes and shapes tested per ray; for the kd-tree planes met, for the grid cells entered;\n"
      "  repeated: shapes that the same ray had tested before; bytes per primitive\n";

  text += fmt::format("\nGrowth over {}:N, rays as above\n\n", report.growth_family);
  text += growth_table(report.growth) + "\n" + growth_words(report);

  text += "\nThe worst case, duplicates:N: all triangles in one place, every ray hits\n\n";
  text += growth_table(report.worst_case);
  if (!report.worst_case.empty()) {
    const auto least = std::min_element(report.worst_case.begin(), report.worst_case.end(),
                                        [](const auto& a, const auto& b) { return a.exponent < b.exponent; });
    text += fmt::format(
        "\n  No box, plane or cell tells one from another: the least exponent is {:.2f}, all fall back\n"
        "  to N.\n",
        least->exponent);
  }
  return text;
}

std::string ladder_json(const LadderReport& report) {
  using nlohmann::ordered_json;
  const auto growth_json = [](const std::vector<GrowthReport>& growth) {
    ordered_json list = ordered_json::array();
    for (const GrowthReport& rung : growth) {
      ordered_json points = ordered_json::array();
      for (const GrowthPoint& point : rung.points)
        points.push_back(
            {{"n", point.n}, {"tests_per_ray", point.tests_per_ray}, {"ns_per_ray", point.ns_per_ray}});
      list.push_back({{"rung", rung.rung},
                      {"exponent", rung.exponent},
                      {"time_exponent", rung.time_exponent},
                      {"points", points}});
      if (!rung.stopped.empty()) list.back()["stopped"] = rung.stopped;
    }
    return list;
  };

  ordered_json rungs = ordered_json::array();
  for (const RungReport& rung : report.rungs)
    rungs.push_back({{"name", rung.name},
                     {"build_ms", rung.build_ms},
                     {"mrays_per_s", rung.mrays_per_s},
                     {"box_tests_per_ray", rung.box_tests_per_ray},
                     {"shape_tests_per_ray", rung.shape_tests_per_ray},
                     {"repeated_tests_per_ray", rung.repeated_tests_per_ray},
                     {"bytes_per_primitive", rung.bytes_per_primitive},
                     {"agrees", rung.agrees}});
  const ordered_json json{{"scene", report.scene},
                          {"primitives", report.primitives},
                          {"rays", report.rays},
                          {"rungs", rungs},
                          {"growth", growth_json(report.growth)},
                          {"brute_force_rays", report.brute_force_rays},
                          {"growth_family", report.growth_family},
                          {"worst_case", growth_json(report.worst_case)}};
  return json.dump(2) + "\n";
}

std::string ladder_chart(const LadderReport& report) {
  Panel tests{"Boxes and shapes tested per ray", "primitives, N", "tests per ray", false, {}};
  Panel times{"Time per ray, one thread", "primitives, N", "time per ray", true, {}};
  for (const GrowthReport& rung : report.growth) {
    Series of_tests{rung.rung, rung.exponent, {}};
    Series of_times{rung.rung, rung.time_exponent, {}};
    for (const GrowthPoint& point : rung.points) {
      of_tests.points.emplace_back(double(point.n), point.tests_per_ray);
      of_times.points.emplace_back(double(point.n), point.ns_per_ray);
    }
    tests.series.push_back(of_tests);
    times.series.push_back(of_times);
  }
  return log_log_chart(
      "From N to log N",
      "Closest hit in " + report.growth_family +
          ":N. Behind each name the power of N that fits its curve; a straight line is a power of N.",
      {tests, times});
}

}  // namespace boxwood::app
