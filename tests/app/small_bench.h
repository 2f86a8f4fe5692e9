// small_bench.h: a bench of seconds, which the tests of the bench share.
#pragma once

#include "bench.h"
#include "boxwood/gallery/gallery.h"
#include "boxwood_engine.h"
#include "embree_peer.h"

namespace boxwood::app {

using Engines = std::vector<std::unique_ptr<Engine>>;

inline Engines boxwood_alone() {
  Engines engines;
  engines.push_back(boxwood_engine());
  return engines;
}

inline Engines everybody() {
  Engines engines = boxwood_alone();
  for (auto& peer : embree_engines()) engines.push_back(std::move(peer));
  return engines;
}

inline BenchOptions small_bench() {
  BenchOptions options;
  options.threads = {1, 2};
  options.repetitions = 2;
  options.rays_per_set = 1'003;  // not a whole number of packets, and larger than one of the batches
  return options;
}

inline BenchReport run_bench(const Engines& engines, const BenchOptions& options,
                             const std::string& scene = "soup:2000") {
  return bench({scene}, engines, options, gallery::make, {});
}

inline const BenchReport& small_report() {
  static const BenchReport report = run_bench(everybody(), small_bench());
  return report;
}
}  // namespace boxwood::app
