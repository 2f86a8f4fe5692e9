#include "bench_ratios.h"

#include <algorithm>

#include <fmt/format.h>

#include "numbers.h"

namespace boxwood::app {
namespace {

std::string place(const std::string& scene, const std::string& set) {
  return short_name(scene) + " " + set;
}

const BuildReport* build_of(const BenchReport& report, const std::string& scene, const std::string& engine,
                            const std::string& preset, int threads) {
  for (const BuildReport& build : report.builds)
    if (build.scene == scene && build.engine == engine && build.preset == preset && build.threads == threads)
      return &build;
  return nullptr;
}

/// Ratios over all scenes and over `sets`, for each peer.
Comparison compare_rates(const BenchReport& report, const std::string& what, const std::string& mode,
                         const std::vector<std::string>& sets, int threads) {
  Comparison line{what, threads, {}};
  for (std::size_t peer = 1; peer < report.engines.size(); ++peer) {
    Spread spread;
    for (const BenchScene& scene : report.scenes)
      for (const std::string& set : sets)
        if (const auto ratio = ratio_of(report, scene.name, report.engines[peer], mode, set, threads))
          spread.add(*ratio, place(scene.name, set));
    line.beside.push_back(spread);
  }
  return line;
}

/// Their time over ours.
Comparison compare_builds(const BenchReport& report, const std::string& preset, const std::string& theirs,
                          int threads) {
  Comparison line{fmt::format("build: {} over {}", preset, theirs), threads, {}};
  for (std::size_t peer = 1; peer < report.engines.size(); ++peer) {
    Spread spread;
    for (const BenchScene& scene : report.scenes) {
      const BuildReport* a = build_of(report, scene.name, report.engines[0], preset, threads);
      const BuildReport* b = build_of(report, scene.name, report.engines[peer], theirs, threads);
      if (a && b) spread.add(b->build_ms / a->build_ms, short_name(scene.name));
    }
    line.beside.push_back(spread);
  }
  return line;
}

}  // namespace

std::optional<double> rate_of(const BenchReport& report, const std::string& scene, const std::string& engine,
                              const std::string& mode, const std::string& set, int threads) {
  for (const RateReport& rate : report.rates)
    if (rate.scene == scene && rate.engine == engine && rate.mode == mode && rate.set == set &&
        rate.threads == threads)
      return rate.mrays_per_s;
  return std::nullopt;
}

std::optional<double> ratio_of(const BenchReport& report, const std::string& scene, const std::string& peer,
                               const std::string& mode, const std::string& set, int threads) {
  const auto ours = rate_of(report, scene, report.engines[0], mode, set, threads);
  const auto single = rate_of(report, scene, peer, "single", set, threads);
  const auto packet = rate_of(report, scene, peer, "packet16", set, threads);
  if (!ours || !single) return std::nullopt;
  return *ours / (mode == "single" ? *single : std::max(*single, packet.value_or(0)));
}

std::vector<Comparison> compare_with_peers(const BenchReport& report) {
  std::vector<std::string> own_sets, all_sets{std::begin(kRaySetNames), std::end(kRaySetNames)};
  for (const RaySet& set : report.options.own_sets) own_sets.push_back(set.name);
  all_sets.insert(all_sets.end(), own_sets.begin(), own_sets.end());

  std::vector<Comparison> lines;
  const std::vector<int>& threads = report.options.threads;
  lines.push_back(compare_rates(report, "single: all sets", "single", all_sets, threads[0]));
  const auto add_batches = [&](const std::string& what, const std::vector<std::string>& sets) {
    for (const int t : threads) lines.push_back(compare_rates(report, "batch: " + what, "batch", sets, t));
  };
  add_batches("bounces, random", {"bounce1", "bounce2", "random"});
  add_batches("occlusion", {"occlusion"});
  add_batches("primary", {"primary"});
  for (const std::string& set : own_sets) add_batches(set, {set});
  for (const int t : threads) lines.push_back(compare_builds(report, "balanced", "medium", t));
  for (const int t : threads) lines.push_back(compare_builds(report, "best", "high", t));

  std::erase_if(lines, [](const Comparison& line) {
    return std::all_of(line.beside.begin(), line.beside.end(), [](const Spread& s) { return s.is_empty(); });
  });
  return lines;
}

std::vector<Figure> own_figures(const BenchReport& report) {
  std::vector<Figure> figures;
  const std::string& ours = report.engines[0];
  const std::vector<int>& threads = report.options.threads;

  for (const int t : threads) {
    Spread spread;
    for (const BenchScene& scene : report.scenes)
      if (const BuildReport* build = build_of(report, scene.name, ours, "fast", t))
        spread.add(1e-3 * double(scene.triangles) / build->build_ms, short_name(scene.name));
    figures.push_back({ours + " fast build, Mtri/s", t, false, spread});
  }

  // What another preset's tree is worth to single rays, beside the engine's usual one.
  const auto add_tree = [&](const std::string& engine, const std::string& preset, const std::string& usual) {
    Spread spread;
    for (const PresetReport& tree : report.trees)
      if (tree.engine == engine && tree.preset == preset)
        if (const auto rate = rate_of(report, tree.scene, engine, tree.mode, tree.set, tree.threads))
          spread.add(tree.mrays_per_s / *rate, place(tree.scene, tree.set));
    figures.push_back(
        {fmt::format("{} {} tree over {}, single", engine, preset, usual), threads[0], true, spread});
  };
  add_tree(ours, "fast", "balanced");
  add_tree(ours, "best", "balanced");
  add_tree("embree", "low", "medium");
  add_tree("embree", "high", "medium");

  for (const std::size_t size : {10'000, 100}) {
    Spread spread;
    for (const BatchSizeReport& batch : report.batch_sizes)
      if (batch.size == size)
        if (const auto rate = rate_of(report, batch.scene, ours, batch.mode, batch.set, batch.threads))
          spread.add(batch.mrays_per_s / *rate, place(batch.scene, batch.set));
    figures.push_back(
        {fmt::format("{} batch of {} over all", ours, with_commas(size)), threads[0], true, spread});
  }

  for (const auto& [engine, preset] :
       {std::pair(ours, "balanced"), std::pair(std::string("embree"), "medium")}) {
    Spread spread(true);
    for (const BenchScene& scene : report.scenes)
      if (const BuildReport* build = build_of(report, scene.name, engine, preset, threads[0]))
        spread.add(build->bytes_per_triangle, short_name(scene.name));
    figures.push_back({fmt::format("{} {} tree, bytes/triangle", engine, preset), threads[0], false, spread});
  }
  std::erase_if(figures, [](const Figure& figure) { return figure.spread.is_empty(); });
  return figures;
}

}  // namespace boxwood::app
