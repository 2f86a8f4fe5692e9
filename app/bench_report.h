// bench_report.h: how does one read what the bench measured: as tables, as JSON, as a picture?
#pragma once

#include <string>

#include "bench.h"

namespace boxwood::app {

/// For a terminal of 100 columns: rates, builds and ratios for each scene, then geometric means over all.
std::string bench_table(const BenchReport& report);

/// {"machine", "rates": [{"scene", "engine", "mode", "set", "threads", "mrays_per_s", "hits", "checksum"}],
/// "builds": [{"scene", "engine", "preset", "threads", "build_ms", "bytes_per_triangle"}]}, and besides
/// "rays_per_set", "repetitions", "disagreements", "trees" (as rates, with "preset") and "batch_sizes" (as
/// rates, with "size").
std::string bench_json(const BenchReport& report);

/// An SVG picture: the rate of every engine on every set, one panel for each number of threads.
std::string bench_chart(const BenchReport& report);

}  // namespace boxwood::app
