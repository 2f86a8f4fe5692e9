// The rays of the bench: sets are what they are called, and a user's file is read or refused.
#include "bench_rays.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "boxwood/core/error.h"
#include "program.h"
#include "small_bench.h"

namespace boxwood::app {
namespace {

struct RaySets : ::testing::Test {
  const SceneDesc desc = gallery::make("terrain:32");
  const Scene scene{gallery::make("terrain:32")};
  std::vector<RaySet> make(const SceneDesc& from, std::vector<std::string> names) const {
    return make_ray_sets(scene, from, 1'000, names, serial_executor());
  }
};

TEST_F(RaySets, AreThoseThatWereAskedFor) {
  const auto sets = make(desc, {"random", "occlusion", "primary"});
  ASSERT_EQ(sets.size(), 3u);
  EXPECT_EQ(sets[0].name, "primary");
  EXPECT_EQ(sets[0].rays.size(), 24u * 24);  // the largest square of whole tiles
  EXPECT_TRUE(sets[0].is_coherent);
  EXPECT_EQ(sets[1].name, "occlusion");
  EXPECT_EQ(sets[1].rays.size(), 1'000u);
  EXPECT_EQ(sets[1].question, Question::any_hit);
  const float diagonal = length(scene.bounds().extent());
  for (const Ray& ray : sets[1].rays) EXPECT_EQ(ray.t_max, 0.1f * diagonal);
  EXPECT_EQ(sets[2].name, "random");
  for (const Ray& ray : sets[2].rays) EXPECT_TRUE(scene.bounds().contains(ray.origin));
}

TEST_F(RaySets, PrimaryRaysComeInTiles) {
  const std::vector<Ray> rays = make(desc, {"primary"})[0].rays;
  // Along a row of pixels steps are alike; the ninth ray begins the tile's next row.
  const Vec3 step = rays[1].direction - rays[0].direction;
  const auto is_near = [](Vec3 a, Vec3 b) { return length(a - b) < 0.2f * length(b); };
  for (std::size_t i = 1; i < 8; ++i)
    EXPECT_TRUE(is_near(rays[i].direction - rays[i - 1].direction, step)) << i;
  EXPECT_FALSE(is_near(rays[8].direction - rays[7].direction, step));
  EXPECT_TRUE(is_near(rays[64].direction - rays[7].direction, step)) << "the second tile is to the right";
}

TEST_F(RaySets, BouncesStartOffTheSurface) {
  for (const RaySet& set : make(desc, {"bounce1", "bounce2"})) {
    EXPECT_EQ(set.rays.size(), 1'000u);
    for (const Ray& ray : set.rays) {
      // No hit where it starts; but just behind the start there is the surface that it left.
      const Hit hit = scene.closest_hit(ray);
      EXPECT_GT(hit.t, 0.0f);
      const float size = length(scene.bounds().extent());
      const ScenePoint nearest = scene.closest_point(ray.origin);
      EXPECT_LT(nearest.distance, 1e-4f * size);
      EXPECT_NEAR(length(ray.direction), 1, 1e-5);
    }
  }
}

TEST_F(RaySets, ThatCannotStartAreLeftOut) {
  SceneDesc away = desc;
  away.camera = Camera{Affine3::look_at({0, 1000, 0}, {0, 2000, 0}, {0, 0, 1})};
  const auto sets = make(away, {std::begin(kRaySetNames), std::end(kRaySetNames)});
  ASSERT_EQ(sets.size(), 2u);
  EXPECT_EQ(sets[0].name, "primary");
  EXPECT_EQ(sets[1].name, "random");
}

class RayFile : public ProgramTest {
 protected:
  void write_rays(const std::string& name, const std::vector<Ray>& rays) const {
    std::string bytes(rays.size() * sizeof(Ray), '\0');
    std::memcpy(bytes.data(), rays.data(), bytes.size());
    write(name, bytes);
  }
  void expect_refusal(const std::string& name, const std::string& words) const {
    try {
      read_rays(path(name));
      ADD_FAILURE() << name << " was read";
    } catch (const FileError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.rfind(path(name) + ":", 0), 0u) << what;
      EXPECT_NE(what.find(words), std::string::npos) << what;
    }
  }
};

TEST_F(RayFile, GivesBackWhatWasWritten) {
  write_rays("mine.f32", {{{1, 2, 3}, 0.5f, {4, 5, 6}, 7}, {{0, 0, 0}, -1, {0, 0, -1}, kInfinity}});
  const RaySet set = read_rays(path("mine.f32"));
  EXPECT_EQ(set.name, "mine");
  EXPECT_EQ(set.question, Question::closest_hit);
  ASSERT_EQ(set.rays.size(), 2u);
  EXPECT_EQ(set.rays[0].origin, (Vec3{1, 2, 3}));
  EXPECT_EQ(set.rays[0].t_min, 0.5f);
  EXPECT_EQ(set.rays[0].direction, (Vec3{4, 5, 6}));
  EXPECT_EQ(set.rays[0].t_max, 7.0f);
  EXPECT_EQ(set.rays[1].t_min, 0.0f) << "below 0 counts as 0";
  EXPECT_EQ(set.rays[1].t_max, kInfinity);
}

TEST_F(RayFile, IsRefusedWithItsNameAndTheRay) {
  expect_refusal("nosuch.f32", "no such file");
  write("empty.f32", "");
  expect_refusal("empty.f32", "empty");
  write("short.f32", std::string(33, 'x'));
  expect_refusal("short.f32", "has 33 bytes, expected a multiple of 32");
  const Ray good{{0, 0, 0}, 0, {0, 0, 1}};
  write_rays("nan.f32", {good, {{NAN, 0, 0}, 0, {0, 0, 1}}});
  expect_refusal("nan.f32", "ray 1: has an origin that is not finite");
  write_rays("zero.f32", {{{0, 0, 0}, 0, {0, 0, 0}}});
  expect_refusal("zero.f32", "ray 0: has a direction of size 0");
  write_rays("t.f32", {good, good, {{0, 0, 0}, 0, {0, 0, 1}, NAN}});
  expect_refusal("t.f32", "ray 2: has a t_min or t_max that is not a number");
  write_rays("random.f32", {good});
  expect_refusal("random.f32", "expected another name");
}

TEST_F(RayFile, IsOneMoreSetOfTheProgram) {
  // A sheet of rays from above, some of which end before they arrive.
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i)
    rays.push_back({{0.01f * float(i), 50, 0.02f * float(i)}, 0, {0, -2, 0}, i % 5 ? kInfinity : 1});
  write_rays("sheet.f32", rays);
  const Outcome outcome =
      run("bench terrain:16 --rays sheet.f32 --sets random --rays-per-set 64 --repeat 1 --threads 1 --quiet "
          "--json a.json "
          "--plot a.svg");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("sheet"), std::string::npos) << outcome.out;
  const auto json = nlohmann::json::parse(read("a.json"));
  const Scene scene(gallery::make("terrain:16"));
  std::size_t hits = 0, seen = 0;
  for (const Ray& ray : rays) hits += scene.closest_hit(ray).is_hit();
  for (const auto& rate : json.at("rates"))
    if (rate.at("set") == "sheet") {
      ++seen;
      EXPECT_EQ(rate.at("hits"), hits) << rate;
    }
  EXPECT_EQ(seen, 2 * everybody().size());
  EXPECT_NE(read("a.svg").find("sheet"), std::string::npos);
}

TEST_F(RayFile, AndWrongUsage) {
  const auto expect_code = [&](const std::string& arguments, int code, const std::string& words) {
    const Outcome outcome = run("bench " + arguments);
    EXPECT_EQ(outcome.exit_code, code) << arguments << outcome.err;
    EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  };
  expect_code("soup:100 --sets fog", 2, "fog");
  expect_code("soup:100 --sets primary,fog", 2, "fog");
  expect_code("soup:100 --threads -1", 2, "--threads");
  expect_code("soup:100 --repeat 0", 2, "--repeat");
  expect_code("soup:100 --rays-per-set 1", 2, "--rays-per-set");
  expect_code("soup:100 soup:100", 2, "twice");
  expect_code("soup:100 --rays nosuch.f32", 1, "nosuch.f32");
  expect_code("soup:100 --json no/folder/a.json", 1, "no/folder");
  expect_code("soup:20000000 nosuch.obj", 1, "nosuch.obj");  // found before the long work
  expect_code("spheres:10 --quiet", 1, "no triangles");
  EXPECT_EQ(file_count(), 0u);
}

}  // namespace
}  // namespace boxwood::app
