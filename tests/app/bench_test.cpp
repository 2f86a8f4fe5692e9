// The bench on small scenes: all engines agree, a lying one is found out, ratios are what they say, and the
// outputs hold what they promise. No test looks at a time.
#include "bench.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench_ratios.h"
#include "bench_report.h"
#include "boxwood/core/error.h"
#include "boxwood/gallery/gallery.h"
#include "boxwood_engine.h"
#include "embree_peer.h"
#include "program.h"

namespace boxwood::app {
namespace {

using Engines = std::vector<std::unique_ptr<Engine>>;

Engines boxwood_alone() {
  Engines engines;
  engines.push_back(boxwood_engine());
  return engines;
}

Engines everybody() {
  Engines engines = boxwood_alone();
  for (auto& peer : embree_engines()) engines.push_back(std::move(peer));
  return engines;
}

BenchOptions small_bench() {
  BenchOptions options;
  options.threads = {1, 2};
  options.repetitions = 2;
  options.rays_per_set = 1'003;  // not a whole number of packets, and larger than one of the batches
  return options;
}

BenchReport run_bench(const Engines& engines, const BenchOptions& options,
                      const std::string& scene = "soup:2000") {
  return bench({scene}, engines, options, gallery::make, {});
}

const BenchReport& small_report() {
  static const BenchReport report = run_bench(everybody(), small_bench());
  return report;
}

TEST(Bench, AllEnginesAgreeInAllModes) {
  const BenchReport& report = small_report();
  EXPECT_EQ(report.disagreements, std::vector<std::string>{});
  const std::size_t engines = report.engines.size();
  EXPECT_EQ(report.rates.size(), 5 * 2 * 2 * engines);  // sets, threads, modes
  for (const RateReport& rate : report.rates) {
    EXPECT_GT(rate.mrays_per_s, 0) << rate.engine << rate.set;
    EXPECT_GT(rate.answers.hits, 10u) << rate.engine << rate.set;
    EXPECT_GT(rate.answers.checksum, 0) << rate.engine << rate.set;
  }
  EXPECT_EQ(report.builds.size(), 2u * (engines > 1 ? 3 + 3 + 1 : 3));
  for (const BuildReport& build : report.builds) {
    EXPECT_GT(build.build_ms, 0);
    EXPECT_GT(build.bytes_per_triangle, 10) << build.engine << build.preset;
    EXPECT_LT(build.bytes_per_triangle, 400) << build.engine << build.preset;
  }
  ASSERT_EQ(report.batch_sizes.size(), 1u);
  EXPECT_EQ(report.batch_sizes[0].size, 100u);
  EXPECT_EQ(report.trees.size(), 5u * (engines > 1 ? 4 : 2));
}

TEST(Bench, StandsAloneWithoutPeers) {
  const BenchReport report = run_bench(boxwood_alone(), small_bench());
  EXPECT_EQ(report.engines, std::vector<std::string>{"boxwood"});
  EXPECT_EQ(report.rates.size(), 20u);
  EXPECT_NE(bench_table(report).find("Boxwood stands alone"), std::string::npos);
  EXPECT_EQ(bench_table(report).find("over its peers"), std::string::npos);
  EXPECT_EQ(bench_chart(report).find("Embree"), std::string::npos);
}

/// Boxwood under another name, which changes its answers before it gives them.
class Liar final : public Engine {
 public:
  using Lie = std::function<void(Answers&)>;
  explicit Liar(Lie lie) : lie_(std::move(lie)), truth_(boxwood_engine()) {}
  std::string name() const override { return "liar"; }
  std::vector<std::string> modes() const override { return {"single"}; }
  std::vector<std::string> presets() const override { return {"balanced"}; }
  std::string traced_preset() const override { return "balanced"; }
  std::unique_ptr<BuiltScene> build(const TriangleMesh& mesh, const std::string& preset, int threads,
                                    const Progress& progress) const override {
    return std::make_unique<Tree>(truth_->build(mesh, preset, threads, progress), lie_);
  }

 private:
  struct Tree final : BuiltScene {
    Tree(std::unique_ptr<BuiltScene> tree, const Lie& told) : truth(std::move(tree)), lie(told) {}
    double build_ms() const override { return truth->build_ms(); }
    std::size_t size_bytes() const override { return truth->size_bytes(); }
    std::unique_ptr<Work> prepare(std::span<const Ray> rays, const TraceOptions& options) const override {
      return std::make_unique<LyingWork>(truth->prepare(rays, options), lie);
    }
    std::unique_ptr<BuiltScene> truth;
    const Lie& lie;
  };
  struct LyingWork final : Work {
    LyingWork(std::unique_ptr<Work> work, const Lie& told) : truth(std::move(work)), lie(told) {}
    void run(Executor& executor) override { truth->run(executor); }
    Answers answers() const override {
      Answers answers = truth->answers();
      lie(answers);
      return answers;
    }
    std::unique_ptr<Work> truth;
    const Lie& lie;
  };
  Lie lie_;
  std::unique_ptr<Engine> truth_;
};

std::vector<std::string> disagreements_with(Liar::Lie lie) {
  Engines engines = boxwood_alone();
  engines.push_back(std::make_unique<Liar>(std::move(lie)));
  BenchOptions options = small_bench();
  options.sets = {"bounce1"};
  options.threads = {1};
  return run_bench(engines, options).disagreements;
}

TEST(Bench, FindsOutWhoDisagrees) {
  EXPECT_EQ(disagreements_with([](Answers&) {}), std::vector<std::string>{});
  const auto hits = disagreements_with([](Answers& answers) { answers.hits += 5; });
  ASSERT_EQ(hits.size(), 1u);
  EXPECT_EQ(hits[0].rfind("soup:2000, bounce1: liar single on 1 thread: ", 0), 0u) << hits[0];
  const auto sums = disagreements_with([](Answers& answers) { answers.checksum *= 1.1; });
  ASSERT_EQ(sums.size(), 1u);
  EXPECT_NE(sums[0].find("t sums to"), std::string::npos) << sums[0];
  const auto fickle = disagreements_with([calls = 0](Answers& answers) mutable { answers.hits += calls++; });
  ASSERT_EQ(fickle.size(), 1u);
  EXPECT_NE(fickle[0].find("repetition"), std::string::npos) << fickle[0];
}

TEST(Bench, SaysWhereTheAnswersOfEnginesMayDiffer) {
  const Answers ours{1'000'000, 2e6, 10};
  EXPECT_EQ(difference(ours, ours), "");
  EXPECT_EQ(difference(ours, {1'000'102, 2e6, 10}), "");
  EXPECT_NE(difference(ours, {1'000'103, 2e6, 10}), "");
  EXPECT_NE(difference(ours, {999'897, 2e6, 10}), "");
  EXPECT_EQ(difference(ours, {1'000'000, 2e6 + 219, 10}), "");
  EXPECT_NE(difference(ours, {1'000'000, 2e6 + 221, 10}), "");
  EXPECT_NE(difference(ours, {1'000'000, NAN, 10}), "");
  EXPECT_EQ(difference({}, {}), "");
}

TEST(Bench, FlattensInstancesAndLeavesOtherShapesOut) {
  SceneDesc desc;
  const GeometryId mesh = desc.add(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}});
  const GeometryId balls = desc.add(std::vector<Sphere>{{{0, 0, 0}, 1}, {{5, 0, 0}, 1}});
  desc.add(Instance{mesh, Affine3::translation({0, 0, 5}), {}});
  desc.add(Instance{balls, Affine3::identity(), {}});
  desc.add(Instance{mesh, Affine3::scale(2), {}});
  const FlatMesh flat = flatten_triangles(desc);
  EXPECT_EQ(flat.left_out, 2u);
  ASSERT_EQ(flat.mesh.indices.size(), 2u);
  const auto corner = [&](std::size_t triangle, std::size_t k) {
    return flat.mesh.positions[flat.mesh.indices[triangle][k]];
  };
  EXPECT_EQ(corner(0, 1), (Vec3{1, 0, 5}));
  EXPECT_EQ(corner(1, 1), (Vec3{2, 0, 0}));
}

TEST(Bench, RefusesScenesWithoutTriangles) {
  EXPECT_THROW(run_bench(boxwood_alone(), small_bench(), "spheres:10"), std::invalid_argument);
}

TEST(Bench, GoesOnWithTheScenesThatHaveTriangles) {
  BenchOptions options = small_bench();
  options.sets = {"random"};
  const BenchReport report = bench({"spheres:10", "soup:100"}, boxwood_alone(), options, gallery::make, {});
  ASSERT_EQ(report.scenes.size(), 2u);
  EXPECT_EQ(report.scenes[0].triangles, 0u);
  EXPECT_EQ(report.scenes[0].left_out, 10u);
  for (const RateReport& rate : report.rates) EXPECT_EQ(rate.scene, "soup:100");
  EXPECT_NE(bench_table(report).find("spheres:10: 0 triangles (10 other shapes left out)\n\nsoup:100"),
            std::string::npos);
  EXPECT_EQ(bench_chart(report).find("spheres"), std::string::npos);
}

TEST(Bench, StopsWhenAsked) {
  // At once, and at any later time: while trees are built, while rays are on their way.
  for (int patience = 0; patience < 40; patience += 3) {
    int told = 0;
    EXPECT_THROW(bench({"soup:2000"}, everybody(), small_bench(), gallery::make,
                       [&](std::string_view, double) { return told++ < patience; }),
                 Cancelled);
  }
}

TEST(Bench, EveryEngineStopsInTheMiddleOfABuild) {
  const TriangleMesh mesh = flatten_triangles(gallery::make("soup:100000")).mesh;
  for (const auto& engine : everybody())
    for (const std::string& preset : engine->presets()) {
      const auto stop = [](std::string_view, double) { return false; };
      EXPECT_THROW(engine->build(mesh, preset, 2, stop), Cancelled) << engine->name() << " " << preset;
      EXPECT_GT(engine->build(mesh, preset, 2, {})->size_bytes(), mesh.indices.size())
          << "and goes on after that";
    }
}

TEST(Bench, TellsProgressThatNeverGoesBack) {
  double last = 0;
  BenchOptions options = small_bench();
  options.sets = {"primary"};
  bench({"soup:500", "terrain:16"}, everybody(), options, gallery::make,
        [&](std::string_view stage, double done) {
          EXPECT_GE(done, last) << stage;
          EXPECT_LE(done, 1) << stage;
          last = done;
          return true;
        });
  EXPECT_GT(last, 0.9);
}

// A denormal times a half is zero on a thread that flushes.
TEST(Bench, EmbreeLeavesTheArithmeticOfOurThreadsAlone) {
  const TriangleMesh mesh = flatten_triangles(gallery::make("soup:5000")).mesh;
  const std::vector<Ray> rays(5'000, Ray{{0, 0, 0}, 0, {1, 1, 1}});
  const std::unique_ptr<Executor> two = make_executor(2);
  for (const auto& engine : embree_engines()) {
    const auto tree = engine->build(mesh, "medium", 2, {});
    for (const std::string& mode : engine->modes())
      tree->prepare(rays, {mode, Question::closest_hit, false, 0})->run(*two);
    for (Executor* executor : {two.get(), &default_executor()})
      executor->for_range(0, 64, 1, [](std::size_t, std::size_t) {
        volatile float denormal = 1e-40f, half = 0.5f;
        const float product = denormal * half;
        EXPECT_NE(std::bit_cast<std::uint32_t>(product), 0u);
      });
  }
}

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
