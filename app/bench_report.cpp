#include "bench_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench_ratios.h"
#include "dot_chart.h"
#include "embree_peer.h"
#include "numbers.h"
#include "table.h"

namespace boxwood::app {
namespace {

/// Three digits that tell something: 0.0123, 1.45, 45.6, 1,234.
std::string compact(double value) {
  const double size = std::fabs(value);
  return with_commas(value, size >= 100 ? 0 : size >= 10 ? 1 : size >= 0.1 ? 2 : 4);
}
std::string compact(std::optional<double> value) {
  return value ? compact(*value) : "-";
}
std::string times(std::optional<double> ratio) {
  return ratio ? fmt::format("{:.2f}x", *ratio) : "-";
}

/// What fits over a narrow column.
std::string short_engine(const std::string& engine) {
  return engine == "embree-robust" ? "robust" : engine;
}

/// The modes of an engine, in the order in which they were measured.
std::vector<std::string> modes_of(const BenchReport& report, const std::string& engine) {
  std::vector<std::string> modes;
  for (const RateReport& rate : report.rates)
    if (rate.engine == engine && std::find(modes.begin(), modes.end(), rate.mode) == modes.end())
      modes.push_back(rate.mode);
  return modes;
}

/// The sets that a scene was measured with, in their order.
std::vector<std::string> sets_of(const BenchReport& report, const std::string& scene) {
  std::vector<std::string> sets;
  for (const RateReport& rate : report.rates)
    if (rate.scene == scene && std::find(sets.begin(), sets.end(), rate.set) == sets.end())
      sets.push_back(rate.set);
  return sets;
}

/// A row of columns under shared titles: the rates of each engine, then our ratios to each peer.
std::string rate_table(const BenchReport& report, const BenchScene& scene) {
  constexpr int kSetWidth = 13, kWidth = 7, kModeWidth = 9;
  std::string titles(kSetWidth + 4, ' '),
      head = fmt::format("  {:<8}{:>{}}", "Mrays/s", "threads", kSetWidth + 2 - 8);
  for (const std::string& engine : report.engines) {
    const auto modes = modes_of(report, engine);
    titles += fmt::format("{:>{}}", engine, kModeWidth * modes.size());
    for (const std::string& mode : modes) head += fmt::format("{:>{}}", mode, kModeWidth);
  }
  for (std::size_t peer = 1; peer < report.engines.size(); ++peer) {
    const std::string& name = report.engines[peer];
    titles += fmt::format("{:>{}}", "over " + short_engine(name), 2 * kWidth);
    for (const char* mode : {"single", "batch"}) head += fmt::format("{:>{}}", mode, kWidth);
  }
  std::string text = titles + "\n" + head + "\n  ";
  for (std::size_t i = 2; i < head.size(); ++i) text += "─";
  text += "\n";

  for (const std::string& set : sets_of(report, scene.name))
    for (const int threads : report.options.threads) {
      const bool is_first = threads == report.options.threads.front();
      text += fmt::format("  {:<{}.{}}{:>2}", is_first ? set : "", kSetWidth, kSetWidth - 1, threads);
      for (const std::string& engine : report.engines)
        for (const std::string& mode : modes_of(report, engine))
          text += fmt::format("{:>{}}", compact(rate_of(report, scene.name, engine, mode, set, threads)),
                              kModeWidth);
      for (std::size_t peer = 1; peer < report.engines.size(); ++peer)
        for (const char* mode : {"single", "batch"})
          text += fmt::format("{:>{}}",
                              times(ratio_of(report, scene.name, report.engines[peer], mode, set, threads)),
                              kWidth);
      text += "\n";
    }
  return text;
}

std::string build_table(const BenchReport& report, const BenchScene& scene) {
  std::vector<std::string> head{"build"};
  for (const int threads : report.options.threads) {
    head.push_back(fmt::format("ms, {} thread{}", threads, threads == 1 ? "" : "s"));
    head.push_back("Mtri/s");
  }
  head.push_back("bytes/triangle");
  Table table(head);
  for (const std::string& engine : report.engines)
    for (const BuildReport& first : report.builds) {
      if (first.scene != scene.name || first.engine != engine ||
          first.threads != report.options.threads.front())
        continue;
      std::vector<std::string> row{engine + " " + first.preset};
      for (const int threads : report.options.threads)
        for (const BuildReport& build : report.builds)
          if (build.scene == scene.name && build.engine == engine && build.preset == first.preset &&
              build.threads == threads) {
            row.push_back(with_commas(build.build_ms, build.build_ms < 100 ? 1 : 0));
            row.push_back(compact(1e-3 * double(scene.triangles) / build.build_ms));
          }
      row.push_back(with_commas(first.bytes_per_triangle, 1));
      table.add(row);
    }
  return table.text();
}

std::string summary(const BenchReport& report) {
  std::string text;
  if (report.engines.size() > 1) {
    std::vector<std::string> head{"Boxwood over its peers", "threads"};
    for (std::size_t peer = 1; peer < report.engines.size(); ++peer) {
      head.push_back(short_engine(report.engines[peer]));
      head.push_back("least");
    }
    head.push_back("least at");
    Table table(head);
    for (const Comparison& line : compare_with_peers(report)) {
      std::vector<std::string> row{line.what, std::to_string(line.threads)};
      for (const Spread& spread : line.beside) {
        row.push_back(spread.is_empty() ? "-" : times(spread.mean()));
        row.push_back(spread.is_empty() ? "-" : times(spread.worst()));
      }
      row.push_back(line.beside.front().where());
      table.add(row);
    }
    text += "\nGeometric means over all scenes\n\n" + table.text();
    text +=
        "  single: rays one by one on both sides; batch: over the better of the peer's single rays and\n"
        "  packets; build: the peer's time over ours\n";
  }

  Table table({"engines by themselves", "threads", "mean", "worst", "worst at"});
  for (const Figure& figure : own_figures(report)) {
    const auto show = [&](double value) { return figure.is_ratio ? times(value) : compact(value); };
    table.add({figure.what, std::to_string(figure.threads), show(figure.spread.mean()),
               show(figure.spread.worst()), figure.spread.where()});
  }
  return text + "\n" + table.text();
}

}  // namespace

std::string bench_table(const BenchReport& report) {
  const bool has_peers = report.engines.size() > 1;
  const int rounds = report.options.repetitions;
  std::string text = report.machine + "\n";
  text += fmt::format("{} rays a set; {}{}\n", with_commas(report.options.rays_per_set),
                      rounds == 1 ? "one round" : fmt::format("medians of {} rounds", rounds),
                      has_peers ? ", engines taking turns" : "");
  text += has_peers ? fmt::format("Embree {}: denormals flushed, medium quality where rays are timed\n",
                                  embree_version())
                    : "Embree was not found when this program was configured: Boxwood stands alone\n";
  for (const std::string& what : report.disagreements) text += "ANSWERS DIFFER: " + what + "\n";
  if (report.disagreements.empty())
    text +=
        has_peers
            ? "All answers agree: Boxwood's to the last bit, hits and sums of t of all engines within 1e-4\n"
            : "All answers agree, to the last bit\n";

  for (const BenchScene& scene : report.scenes) {
    text += fmt::format("\n{}: {} triangles", scene.name, with_commas(scene.triangles));
    if (scene.left_out > 0) text += fmt::format(" ({} other shapes left out)", with_commas(scene.left_out));
    text += "\n";
    if (scene.triangles > 0) text += "\n" + rate_table(report, scene) + "\n" + build_table(report, scene);
  }
  return text + summary(report);
}

std::string bench_json(const BenchReport& report) {
  using nlohmann::ordered_json;
  const auto rate_json = [](const RateReport& rate) {
    return ordered_json{{"scene", rate.scene},       {"engine", rate.engine},
                        {"mode", rate.mode},         {"set", rate.set},
                        {"threads", rate.threads},   {"mrays_per_s", rate.mrays_per_s},
                        {"hits", rate.answers.hits}, {"checksum", rate.answers.checksum}};
  };
  ordered_json rates = ordered_json::array(), builds = ordered_json::array(), trees = ordered_json::array(),
               batch_sizes = ordered_json::array();
  for (const RateReport& rate : report.rates) rates.push_back(rate_json(rate));
  for (const PresetReport& tree : report.trees) {
    trees.push_back(rate_json(tree));
    trees.back()["preset"] = tree.preset;
  }
  for (const BatchSizeReport& batch : report.batch_sizes) {
    batch_sizes.push_back(rate_json(batch));
    batch_sizes.back()["size"] = batch.size;
  }
  for (const BuildReport& build : report.builds)
    builds.push_back({{"scene", build.scene},
                      {"engine", build.engine},
                      {"preset", build.preset},
                      {"threads", build.threads},
                      {"build_ms", build.build_ms},
                      {"bytes_per_triangle", build.bytes_per_triangle}});
  const ordered_json json{{"machine", report.machine},
                          {"rates", rates},
                          {"builds", builds},
                          {"rays_per_set", report.options.rays_per_set},
                          {"repetitions", report.options.repetitions},
                          {"disagreements", report.disagreements},
                          {"trees", trees},
                          {"batch_sizes", batch_sizes}};
  return json.dump(2) + "\n";
}

std::string bench_chart(const BenchReport& report) {
  DotChart chart;
  chart.title = report.engines.size() > 1 ? "Rays per second, beside Embree" : "Rays per second";
  chart.subtitle = report.machine;
  chart.x_label = "million rays per second";
  for (const std::string& engine : report.engines)
    for (const std::string& mode : modes_of(report, engine)) chart.series.push_back(engine + " " + mode);
  if (report.engines.size() > 1)
    chart.note = fmt::format("Behind each row: boxwood batch over the better of {0} single and {0} packet16.",
                             report.engines[1]);

  for (const int threads : report.options.threads) {
    DotPanel panel{fmt::format("{} thread{}", threads, threads == 1 ? "" : "s"), {}};
    for (const BenchScene& scene : report.scenes) {
      if (scene.triangles == 0) continue;
      DotGroup group{short_name(scene.name), {}};
      for (const std::string& set : sets_of(report, scene.name)) {
        DotRow row{set, {}, ""};
        for (const std::string& engine : report.engines)
          for (const std::string& mode : modes_of(report, engine))
            row.values.push_back(rate_of(report, scene.name, engine, mode, set, threads).value_or(0));
        if (report.engines.size() > 1)
          row.note = times(ratio_of(report, scene.name, report.engines[1], "batch", set, threads));
        group.rows.push_back(row);
      }
      panel.groups.push_back(group);
    }
    chart.panels.push_back(panel);
  }
  return dot_chart(chart);
}

}  // namespace boxwood::app
