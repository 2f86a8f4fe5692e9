// ladder_report.h: how does one read what the ladder measured: as a table, as JSON, as a picture?
#pragma once

#include <string>

#include "ladder.h"

namespace boxwood::app {

/// For a terminal of 104 columns, with the conclusions in words.
std::string ladder_table(const LadderReport& report);

/// {"scene", "primitives", "rays", "rungs": [{"name", "build_ms", "mrays_per_s", "box_tests_per_ray",
/// "shape_tests_per_ray", "repeated_tests_per_ray", "bytes_per_primitive", "agrees"}], "growth": [{"rung",
/// "exponent", "time_exponent", "points": [{"n", "tests_per_ray", "ns_per_ray"}]}]}, and besides
/// "brute_force_rays", "growth_family", and "worst_case", which is like "growth". "stopped" tells why a
/// rung's points end early.
std::string ladder_json(const LadderReport& report);

/// An SVG picture: tests and time per ray over the number of primitives.
std::string ladder_chart(const LadderReport& report);

}  // namespace boxwood::app
