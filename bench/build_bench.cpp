// build_bench: how long does a tree take, by method and by number of threads?
#include "boxwood/build/build.h"
#include "boxwood/tree/metrics.h"
#include "workload.h"

namespace boxwood::bench {
namespace {

void build_tree(benchmark::State& state, Method method, int threads) {
  const std::vector<Box3> input = boxes(triangles("soup:1000000"));
  const auto executor = make_executor(threads);
  BuildOptions options;
  options.method = method;
  options.executor = executor.get();

  Bvh bvh;
  for (auto _ : state) bvh = build(input, options);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * input.size()));
  state.counters["nodes"] = static_cast<double>(bvh.nodes.size());
  state.counters["sah_cost"] = sah_cost(bvh);
}

BENCHMARK_CAPTURE(build_tree, longest_axis_1_thread, Method::longest_axis, 1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(build_tree, longest_axis_all_threads, Method::longest_axis, 0)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(build_tree, binned_sah_1_thread, Method::binned_sah, 1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(build_tree, binned_sah_all_threads, Method::binned_sah, 0)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(build_tree, sweep_sah_1_thread, Method::sweep_sah, 1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(build_tree, sweep_sah_all_threads, Method::sweep_sah, 0)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace boxwood::bench
