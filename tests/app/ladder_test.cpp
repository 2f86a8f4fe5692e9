// The ladder on small scenes: every rung agrees, the exponents are what theory says, the outputs hold what
// they promise.
#include "ladder.h"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "boxwood/core/error.h"
#include "boxwood/gallery/gallery.h"
#include "boxwood/simd/kernels.h"
#include "chart.h"
#include "flat_shapes.h"
#include "ladder_report.h"
#include "numbers.h"

namespace boxwood::app {
namespace {

LadderOptions small_ladder() {
  LadderOptions options;
  options.rays = 3'000;
  options.growth_sizes = {100, 1'000, 10'000};
  options.worst_case_sizes = {100, 1'000};
  return options;
}

const LadderReport& small_report() {
  static const LadderReport report = climb("soup:3000", gallery::make("soup:3000"), small_ladder(), {});
  return report;
}

const GrowthReport& find(const std::vector<GrowthReport>& growth, const std::string& rung) {
  for (const GrowthReport& report : growth)
    if (report.rung == rung) return report;
  throw std::out_of_range(rung);
}

TEST(Ladder, ClimbsEveryRungAndAllAgree) {
  std::vector<std::string> names{"brute force", "seed BVH",  "flat, no recursion", "nearer child first",
                                 "binned SAH",  "sweep SAH", "wide tree"};
  if (simd::kernels()) names.insert(names.end(), {"SIMD kernel", "SIMD kernel, batch"});
  const std::size_t first_rival = names.size();
  names.insert(names.end(), {"kd-tree", "octree", "uniform grid"});
  ASSERT_EQ(small_report().rungs.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const RungReport& rung = small_report().rungs[i];
    EXPECT_EQ(rung.name, names[i]);
    EXPECT_TRUE(rung.agrees) << rung.name;
    EXPECT_GT(rung.mrays_per_s, 0) << rung.name;
    EXPECT_EQ(rung.repeated_tests_per_ray > 0, i >= first_rival) << rung.name;
  }
  EXPECT_EQ(small_report().rungs[0].shape_tests_per_ray, 3000);
  EXPECT_EQ(small_report().rungs[1].box_tests_per_ray, small_report().rungs[2].box_tests_per_ray);
}

TEST(Ladder, TheUpperRungsAskOneTree) {
  if (!simd::kernels()) return;
  const auto rung = [](std::string_view name) {
    for (const RungReport& report : small_report().rungs)
      if (report.name == name) return report;
    throw std::out_of_range(std::string(name));
  };
  const RungReport wide = rung("wide tree"), single = rung("SIMD kernel"), batch = rung("SIMD kernel, batch");
  EXPECT_EQ(single.box_tests_per_ray, batch.box_tests_per_ray);
  EXPECT_EQ(single.shape_tests_per_ray, batch.shape_tests_per_ray);
  if (simd::kernels()->width != 8) return;
  EXPECT_EQ(single.box_tests_per_ray, wide.box_tests_per_ray);
  EXPECT_EQ(single.shape_tests_per_ray, wide.shape_tests_per_ray);
}

TEST(Ladder, FindsTheExponentsOfTheory) {
  const auto& growth = small_report().growth;
  EXPECT_NEAR(find(growth, "brute force").exponent, 1, 1e-9);
  EXPECT_LT(find(growth, "binned SAH").exponent,
            0.4);  // below 0.3 over the whole range; here the start is steep
  EXPECT_LT(find(growth, "sweep SAH").exponent, 0.4);
  for (const GrowthReport& rung : small_report().worst_case) {
    EXPECT_GT(rung.exponent, 0.95) << rung.rung;
    for (const GrowthPoint& point : rung.points) EXPECT_GE(point.tests_per_ray, double(point.n)) << rung.rung;
  }
}

TEST(Ladder, StopsRungsThatWouldTakeTooLongAndSaysSo) {
  LadderOptions options = small_ladder();
  options.growth_sizes = {100, 200, 400};
  options.worst_case_sizes = {};
  options.seconds_per_point = 0;  // any estimate is too long
  const LadderReport report = climb("soup:100", gallery::make("soup:100"), options, {});
  for (const GrowthReport& rung : report.growth) {
    EXPECT_EQ(rung.points.size(), 1u) << rung.rung;
    EXPECT_NE(rung.stopped.find("stopped before 200"), std::string::npos) << rung.stopped;
  }
}

TEST(Ladder, GrowsTheFamilyOfItsScene) {
  LadderOptions options = small_ladder();
  options.growth_sizes = {100};
  const LadderReport report = climb("spheres:200", gallery::make("spheres:200"), options, {});
  EXPECT_EQ(report.growth_family, "spheres");
  EXPECT_EQ(report.kind, "spheres");
  for (const RungReport& rung : report.rungs) EXPECT_TRUE(rung.agrees) << rung.name;
}

TEST(Ladder, TakesScenesOfEveryKind) {
  LadderOptions options = small_ladder();
  options.rays = 200;
  options.growth_sizes = options.worst_case_sizes = {};
  for (const char* name : {"cornell", "city:50", "terrain:8", "duplicates:10"}) {
    const LadderReport report = climb(name, gallery::make(name), options, {});
    for (const RungReport& rung : report.rungs) EXPECT_TRUE(rung.agrees) << name << ", " << rung.name;
  }
}

TEST(Ladder, StopsWhenAsked) {
  EXPECT_THROW(climb("soup:100", gallery::make("soup:100"), small_ladder(),
                     [](std::string_view, double) { return false; }),
               Cancelled);
}

TEST(Ladder, RefusesAnEmptyScene) {
  EXPECT_THROW(climb("nothing", SceneDesc{}, small_ladder(), {}), std::invalid_argument);
}

TEST(Ladder, WritesTheJsonThatItPromises) {
  const auto json = nlohmann::json::parse(ladder_json(small_report()));
  EXPECT_EQ(json.at("scene"), "soup:3000");
  EXPECT_EQ(json.at("primitives"), 3000);
  EXPECT_EQ(json.at("rays"), 3000);
  ASSERT_EQ(json.at("rungs").size(), small_report().rungs.size());
  for (const auto& rung : json.at("rungs")) {
    EXPECT_TRUE(rung.at("name").is_string());
    EXPECT_TRUE(rung.at("agrees").is_boolean());
    for (const char* key : {"build_ms", "mrays_per_s", "box_tests_per_ray", "shape_tests_per_ray",
                            "repeated_tests_per_ray", "bytes_per_primitive"})
      EXPECT_TRUE(rung.at(key).is_number()) << key;
  }
  ASSERT_EQ(json.at("growth").size(), small_report().rungs.size());
  for (const auto& rung : json.at("growth")) {
    EXPECT_TRUE(rung.at("rung").is_string());
    EXPECT_TRUE(rung.at("exponent").is_number());
    EXPECT_TRUE(rung.at("time_exponent").is_number());
    ASSERT_EQ(rung.at("points").size(), 3u);
    for (const auto& point : rung.at("points"))
      for (const char* key : {"n", "tests_per_ray", "ns_per_ray"})
        EXPECT_TRUE(point.at(key).is_number()) << key;
  }
}

TEST(Ladder, DrawsACurveForEachRungInBothPanels) {
  const std::string svg = ladder_chart(small_report());
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  std::size_t curves = 0;
  for (std::size_t at = svg.find("class=\"curve\""); at != std::string::npos;
       at = svg.find("class=\"curve\"", at + 1))
    ++curves;
  EXPECT_EQ(curves, 2 * small_report().rungs.size());
}

TEST(Ladder, PrintsATableWithAllRungs) {
  const std::string table = ladder_table(small_report());
  for (const RungReport& rung : small_report().rungs)
    EXPECT_NE(table.find(rung.name), std::string::npos) << rung.name;
  EXPECT_EQ(table.find("NO"), std::string::npos);
}

TEST(FitExponent, FindsThePower) {
  EXPECT_NEAR(fit_exponent({{1, 5}, {10, 50}, {100, 500}}), 1, 1e-12);
  EXPECT_NEAR(fit_exponent({{10, 3}, {1000, 3}}), 0, 1e-12);
  EXPECT_EQ(fit_exponent({{10, 3}}), 0);
}

TEST(FlatShapes, PlacesInstances) {
  SceneDesc desc;
  const GeometryId mesh = desc.add(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}});
  desc.add(Instance{mesh, Affine3::translation({0, 0, 5}), {}});
  desc.add(Instance{mesh, Affine3::scale(2), {}});
  const FlatShapes flat = flatten(desc);
  const auto& triangles = std::get<std::vector<Triangle>>(flat);
  ASSERT_EQ(triangles.size(), 2u);
  EXPECT_EQ(triangles[0].b, (Vec3{1, 0, 5}));
  EXPECT_EQ(triangles[1].b, (Vec3{2, 0, 0}));

  // A sphere under a transform, beside the mesh, stays a sphere in its place.
  const GeometryId ball = desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}});
  desc.add(Instance{ball, Affine3::translation({9, 0, 0}), {}});
  const FlatShapes mixed = flatten(desc);
  const auto& any = std::get<std::vector<AnyShape>>(mixed);
  ASSERT_EQ(any.size(), 3u);
  EXPECT_TRUE(any[2].box().contains(Vec3{10, 0, 0}));
  EXPECT_FALSE(any[2].box().contains(Vec3{7, 0, 0}));
}

TEST(WithCommas, SetsThemByThrees) {
  EXPECT_EQ(with_commas(0), "0");
  EXPECT_EQ(with_commas(999), "999");
  EXPECT_EQ(with_commas(1000), "1,000");
  EXPECT_EQ(with_commas(1443517), "1,443,517");
  EXPECT_EQ(with_commas(-12345.678, 1), "-12,345.7");
}

}  // namespace
}  // namespace boxwood::app
