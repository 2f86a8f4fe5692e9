// What the bench says: ratios are what their names say, and table, JSON and chart hold what they promise.
#include "bench_report.h"

#include <algorithm>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench_ratios.h"
#include "small_bench.h"

namespace boxwood::app {
namespace {

/// Two engines on one scene, with figures that make ratios easy to tell.
BenchReport made_up_report() {
  BenchReport report;
  report.options.threads = {1};
  report.options.sets = {"primary", "bounce1"};
  report.engines = {"boxwood", "embree"};
  report.scenes = {{"a/b/c.obj", 1'000'000, 0}};
  const auto add = [&](const char* engine, const char* mode, const char* set, double rate) {
    report.rates.push_back({"a/b/c.obj", engine, mode, set, 1, rate, {10, 20, 3}});
  };
  add("boxwood", "single", "primary", 6);
  add("boxwood", "batch", "primary", 20);
  add("embree", "single", "primary", 4);
  add("embree", "packet16", "primary", 16);
  add("boxwood", "single", "bounce1", 2);
  add("boxwood", "batch", "bounce1", 9);
  add("embree", "single", "bounce1", 3);
  add("embree", "packet16", "bounce1", 2);
  report.builds = {{"a/b/c.obj", "boxwood", "fast", 1, 100, 50},
                   {"a/b/c.obj", "boxwood", "balanced", 1, 200, 60},
                   {"a/b/c.obj", "embree", "medium", 1, 500, 70}};
  return report;
}

TEST(BenchRatios, AreOursOverTheirs) {
  const BenchReport report = made_up_report();
  const auto ratio = [&](const char* mode, const char* set) {
    return ratio_of(report, "a/b/c.obj", "embree", mode, set, 1);
  };
  EXPECT_DOUBLE_EQ(*ratio("single", "primary"), 1.5);
  EXPECT_DOUBLE_EQ(*ratio("batch", "primary"), 1.25);
  EXPECT_DOUBLE_EQ(*ratio("batch", "bounce1"), 3) << "the better of the peer's two";
  EXPECT_FALSE(ratio("batch", "random"));

  const std::vector<Comparison> lines = compare_with_peers(report);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_NEAR(lines[0].beside[0].mean(), 1, 1e-12) << "of 3/2 and 2/3";
  EXPECT_DOUBLE_EQ(lines[0].beside[0].worst(), 2 / 3.0);
  EXPECT_EQ(lines[0].beside[0].where(), "b/c bounce1");
  EXPECT_DOUBLE_EQ(lines[1].beside[0].mean(), 3);
  EXPECT_DOUBLE_EQ(lines[2].beside[0].mean(), 1.25);
  EXPECT_DOUBLE_EQ(lines[3].beside[0].mean(), 2.5) << "balanced over medium: their time over ours";

  const std::vector<Figure> figures = own_figures(report);
  ASSERT_EQ(figures.size(), 3u);
  EXPECT_NEAR(figures[0].spread.mean(), 10, 1e-9) << "million triangles per second";
  EXPECT_NEAR(figures[1].spread.mean(), 60, 1e-9);
  EXPECT_NEAR(figures[2].spread.mean(), 70, 1e-9);
}

TEST(BenchReport, WritesTheJsonThatItPromises) {
  const auto json = nlohmann::json::parse(bench_json(small_report()));
  EXPECT_TRUE(json.at("machine").is_string());
  const auto expect_rate = [](const nlohmann::json& rate) {
    for (const char* key : {"scene", "engine", "mode", "set"}) EXPECT_TRUE(rate.at(key).is_string()) << key;
    EXPECT_TRUE(rate.at("threads").is_number_integer());
    EXPECT_TRUE(rate.at("mrays_per_s").is_number());
    EXPECT_TRUE(rate.at("hits").is_number_integer());
    EXPECT_TRUE(rate.at("checksum").is_number());
  };
  ASSERT_EQ(json.at("rates").size(), small_report().rates.size());
  std::set<std::string> seen;
  for (const auto& rate : json.at("rates")) {
    expect_rate(rate);
    EXPECT_EQ(rate.size(), 8u);
    EXPECT_TRUE(seen.insert(rate.at("engine").get<std::string>() + "," + rate.at("mode").get<std::string>() +
                            "," + rate.at("set").get<std::string>() + "," + rate.at("threads").dump())
                    .second);
  }
  ASSERT_EQ(json.at("builds").size(), small_report().builds.size());
  for (const auto& build : json.at("builds")) {
    EXPECT_EQ(build.size(), 6u);
    for (const char* key : {"scene", "engine", "preset"}) EXPECT_TRUE(build.at(key).is_string()) << key;
    EXPECT_TRUE(build.at("threads").is_number_integer());
    EXPECT_TRUE(build.at("build_ms").is_number());
    EXPECT_TRUE(build.at("bytes_per_triangle").is_number());
  }
  for (const auto& tree : json.at("trees")) {
    expect_rate(tree);
    EXPECT_TRUE(tree.at("preset").is_string());
  }
  ASSERT_EQ(json.at("batch_sizes").size(), 1u);
  expect_rate(json.at("batch_sizes")[0]);
  EXPECT_EQ(json.at("batch_sizes")[0].at("size"), 100);
  EXPECT_EQ(json.at("disagreements").size(), 0u);
}

TEST(BenchReport, FitsATerminalOfAHundredColumns) {
  const std::string table = bench_table(small_report());
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    const auto glyphs = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; });
    EXPECT_LE(glyphs, 100) << line;
  }
  for (const char* words :
       {"soup:2000: 2,000 triangles", "primary", "bounce2", "boxwood balanced", "All answers agree"})
    EXPECT_NE(table.find(words), std::string::npos) << words;
}

TEST(BenchReport, PutsDisagreementsBeforeFigures) {
  BenchReport report = small_report();
  report.disagreements = {"soup:2000, bounce1: somebody counts 5 hits"};
  const std::string table = bench_table(report);
  const std::size_t at = table.find("ANSWERS DIFFER: soup:2000, bounce1: somebody counts 5 hits");
  ASSERT_NE(at, std::string::npos);
  EXPECT_LT(at, table.find("Mrays/s"));
  EXPECT_EQ(table.find("All answers agree"), std::string::npos);
}

TEST(BenchReport, DrawsADotForEachRate) {
  const std::string svg = bench_chart(small_report());
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf\""), std::string::npos);
  std::size_t dots = 0;
  for (std::size_t at = svg.find("class=\"dot\""); at != std::string::npos;
       at = svg.find("class=\"dot\"", at + 1))
    ++dots;
  const std::size_t in_legend = 2 * small_report().engines.size();
  EXPECT_EQ(dots, small_report().rates.size() + in_legend);
}

}  // namespace
}  // namespace boxwood::app
