// The bench on small scenes: all engines agree, a lying one is found out, and everything can be stopped. No
// test looks at a time.
#include "bench.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "bench_report.h"
#include "boxwood/core/error.h"
#include "small_bench.h"

namespace boxwood::app {
namespace {

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
  EXPECT_EQ(report.builds.size(), 2u * (engines > 1 ? 4 + 3 + 1 : 4));
  for (const BuildReport& build : report.builds) {
    EXPECT_GT(build.build_ms, 0);
    EXPECT_GT(build.bytes_per_triangle, 10) << build.engine << build.preset;
    EXPECT_LT(build.bytes_per_triangle, 400) << build.engine << build.preset;
  }
  ASSERT_EQ(report.batch_sizes.size(), 1u);
  EXPECT_EQ(report.batch_sizes[0].size, 100u);
  EXPECT_EQ(report.trees.size(), 5u * (engines > 1 ? 5 : 3));
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

}  // namespace
}  // namespace boxwood::app
