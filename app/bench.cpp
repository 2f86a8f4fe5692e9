#include "bench.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "boxwood/core/error.h"
#include "numbers.h"

namespace boxwood::app {
namespace {

constexpr double kLongBuildMs = 6'000;  // no further round of a build that took so long altogether
constexpr double kBuildShare = 0.4;     // of a scene's time, for the progress bar
constexpr std::size_t kBatchSizes[] = {10'000, 100};
constexpr std::string_view kBatchSizeSet = "bounce1";
constexpr double kTolerance = 1e-4;  // relative, of hits and of checksums
constexpr double kEdgeCases = 2;     // hits that may differ in sets of any size

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

/// "Intel(R) Xeon(R) Processor, 2 threads".
std::string machine_name() {
  std::string model = "unknown processor";
  std::ifstream cpus("/proc/cpuinfo");
  for (std::string line; std::getline(cpus, line);)
    if (const std::size_t colon = line.find(": "); line.starts_with("model name") && colon != line.npos) {
      model = line.substr(colon + 2);
      break;
    }
  const int threads = default_executor().concurrency();
  return fmt::format("{}, {} thread{}", model, threads, threads == 1 ? "" : "s");
}

/// One build, repeated.
struct BuildJob {
  const Engine* engine;
  std::string preset;
  int threads;
  std::vector<double> ms;
  double spent_ms = 0;
};

/// One set of rays through one tree in one way, repeated.
struct TraceJob {
  enum class Kind { rate, tree, batch_size } kind;
  const Engine* engine;
  std::string preset;
  const BuiltScene* scene;
  const RaySet* set;
  int threads;
  TraceOptions options;
  std::vector<double> mrays_per_s;
  Answers answers;
  bool is_steady = true;  // the same answers in each repetition

  /// "boxwood batch on 2 threads", as sentences about disagreements say it.
  std::string name() const {
    std::string text = fmt::format("{} {}", engine->name(), options.mode);
    if (kind == Kind::tree) text += fmt::format(" with the tree \"{}\"", preset);
    if (kind == Kind::batch_size) text += fmt::format(" of {}", with_commas(options.batch_size));
    return text + fmt::format(" on {} thread{}", threads, threads == 1 ? "" : "s");
  }
};

/// The trees of a scene: by engine and preset.
using Trees = std::map<std::pair<const Engine*, std::string>, std::unique_ptr<BuiltScene>>;

class Bench {
 public:
  Bench(const std::vector<std::unique_ptr<Engine>>& engines, const BenchOptions& options,
        const Progress& progress)
      : engines_(engines), options_(options), progress_(progress) {
    report_.machine = machine_name();
    report_.options = options;
    for (const auto& engine : engines) report_.engines.push_back(engine->name());
    for (const int threads : options.threads) executors_[threads] = make_executor(threads);
  }

  /// The `index`-th of `count` scenes.
  void measure(const std::string& name, std::size_t index, std::size_t count, SceneDesc desc) {
    scene_ = name;
    first_ = double(index) / double(count);
    share_ = 1 / double(count);
    tell("rays", 0);
    const FlatMesh flat = flatten_triangles(desc);
    report_.scenes.push_back({name, flat.mesh.indices.size(), flat.left_out});
    if (flat.mesh.indices.empty()) return;
    const std::vector<RaySet> sets = rays_for(desc, flat.mesh);
    desc = {};

    const Trees trees = build(flat.mesh);
    trace(trees, sets);
  }

  BenchReport take_report() { return std::move(report_); }

 private:
  /// Whether to go on.
  bool ask(std::string_view stage, double done) const {
    return !progress_ || progress_(fmt::format("{}: {}", short_name(scene_), stage), first_ + share_ * done);
  }
  void tell(std::string_view stage, double done) const {
    if (!ask(stage, done)) throw Cancelled();
  }

  std::vector<RaySet> rays_for(const SceneDesc& desc, const TriangleMesh& mesh) {
    std::vector<RaySet> sets;
    if (!options_.sets.empty()) {
      SceneDesc of_mesh;
      of_mesh.add(mesh);
      BuildOptions build;
      build.progress = [this](std::string_view, double) { return ask("rays", 0); };
      const Scene scene(std::move(of_mesh), build);
      sets = make_ray_sets(scene, desc, options_.rays_per_set, options_.sets, default_executor());
    }
    sets.insert(sets.end(), options_.own_sets.begin(), options_.own_sets.end());
    return sets;
  }

  /// Measures every preset of every engine, in turns, and keeps the first tree of each.
  Trees build(const TriangleMesh& mesh) {
    std::vector<BuildJob> jobs;
    for (const int threads : options_.threads)
      for (std::size_t preset = 0, most = 1; preset < most; ++preset)
        for (const auto& engine : engines_) {
          const std::vector<std::string> presets = engine->presets();
          most = std::max(most, presets.size());
          if (preset < presets.size()) jobs.push_back({engine.get(), presets[preset], threads, {}});
        }

    Trees trees;
    for (int round = 0; round < options_.repetitions; ++round)
      for (std::size_t j = 0; j < jobs.size(); ++j) {
        BuildJob& job = jobs[j];
        if (job.spent_ms > kLongBuildMs) continue;
        const double done = kBuildShare * (round + double(j) / double(jobs.size())) / options_.repetitions;
        tell("building", done);
        const auto progress = [&](std::string_view, double) { return ask("building", done); };
        std::unique_ptr<BuiltScene> tree = job.engine->build(mesh, job.preset, job.threads, progress);
        job.ms.push_back(tree->build_ms());
        job.spent_ms += job.ms.back();
        trees.try_emplace({job.engine, job.preset}, std::move(tree));
      }

    for (const BuildJob& job : jobs) {
      const double bytes = double(trees.at({job.engine, job.preset})->size_bytes());
      report_.builds.push_back({scene_, job.engine->name(), job.preset, job.threads, median(job.ms),
                                bytes / double(mesh.indices.size())});
    }
    return trees;
  }

  /// Everything that is measured on one set: on each number of threads each mode of each engine; on the first
  /// also the other trees, and batches of other sizes.
  void add_jobs(const Trees& trees, const RaySet& set, std::vector<TraceJob>& jobs) const {
    const auto add = [&](TraceJob::Kind kind, const Engine* engine, const std::string& preset, int threads,
                         const std::string& mode, std::size_t batch_size) {
      jobs.push_back({kind,
                      engine,
                      preset,
                      trees.at({engine, preset}).get(),
                      &set,
                      threads,
                      {mode, set.question, set.is_coherent, batch_size},
                      {},
                      {}});
    };
    for (const int threads : options_.threads)
      for (const auto& engine : engines_)
        for (const std::string& mode : engine->modes())
          add(TraceJob::Kind::rate, engine.get(), engine->traced_preset(), threads, mode, 0);

    const int threads = options_.threads.front();
    for (const auto& engine : engines_)
      for (const std::string& preset : engine->presets())
        if (preset != engine->traced_preset())
          add(TraceJob::Kind::tree, engine.get(), preset, threads, "single", 0);
    const Engine* ours = engines_.front().get();
    if (set.name == kBatchSizeSet)
      for (const std::size_t size : kBatchSizes)
        if (size < set.rays.size())
          add(TraceJob::Kind::batch_size, ours, ours->traced_preset(), threads, "batch", size);
  }

  void trace(const Trees& trees, const std::vector<RaySet>& sets) {
    std::vector<TraceJob> jobs;
    for (const RaySet& set : sets) add_jobs(trees, set, jobs);
    for (int round = 0; round < options_.repetitions; ++round)
      for (std::size_t j = 0; j < jobs.size(); ++j) {
        TraceJob& job = jobs[j];
        const double done = (round + double(j) / double(jobs.size())) / options_.repetitions;
        tell("tracing", kBuildShare + (1 - kBuildShare) * done);

        const std::unique_ptr<Work> work = job.scene->prepare(job.set->rays, job.options);
        const double start = seconds_now();
        work->run(*executors_.at(job.threads));
        const double seconds = std::max(seconds_now() - start, 1e-9);
        job.mrays_per_s.push_back(1e-6 * double(job.set->rays.size()) / seconds);

        const Answers answers = work->answers();
        job.is_steady = job.is_steady && (round == 0 || answers == job.answers);
        job.answers = answers;
      }
    compare(jobs);
    for (const TraceJob& job : jobs) add_to_report(job);
  }

  /// Notes every job whose answers are not those of Boxwood, ray by ray.
  void compare(const std::vector<TraceJob>& jobs) {
    const TraceJob* truth = nullptr;
    for (const TraceJob& job : jobs) {
      // The first job of each set is Boxwood's first mode.
      if (!truth || truth->set != job.set) truth = &job;
      const auto note = [&](const std::string& what) {
        report_.disagreements.push_back(
            fmt::format("{}, {}: {}: {}", scene_, job.set->name, job.name(), what));
      };
      if (!job.is_steady) note("not the same answers in each repetition");
      if (job.engine != truth->engine) {
        if (const std::string what = difference(truth->answers, job.answers); !what.empty()) note(what);
      } else if (!(job.answers == truth->answers)) {
        note(fmt::format("{} hits with checksum {:.17g}, expected exactly {} and {:.17g}", job.answers.hits,
                         job.answers.checksum, truth->answers.hits, truth->answers.checksum));
      }
    }
  }

  void add_to_report(const TraceJob& job) {
    const RateReport rate{scene_,      job.engine->name(),      job.options.mode, job.set->name,
                          job.threads, median(job.mrays_per_s), job.answers};
    switch (job.kind) {
      case TraceJob::Kind::rate:
        report_.rates.push_back(rate);
        break;
      case TraceJob::Kind::tree:
        report_.trees.push_back({rate, job.preset});
        break;
      case TraceJob::Kind::batch_size:
        report_.batch_sizes.push_back({rate, job.options.batch_size});
        break;
    }
  }

  const std::vector<std::unique_ptr<Engine>>& engines_;
  const BenchOptions& options_;
  const Progress& progress_;
  std::map<int, std::unique_ptr<Executor>> executors_;
  std::string scene_;
  double first_ = 0, share_ = 1;  // where the scene stands on the progress bar
  BenchReport report_;
};

}  // namespace

std::string short_name(const std::string& scene) {
  const std::filesystem::path path = scene;
  const std::filesystem::path folder = path.parent_path().filename();
  return (folder / path.stem()).string();
}

FlatMesh flatten_triangles(const SceneDesc& desc) {
  check(desc);
  const std::vector<Instance> placed = placed_instances(desc);
  FlatMesh flat;

  // One place more than there are vertices: Embree reads each with four floats.
  std::size_t vertices = 0, triangles = 0;
  for (const Instance& instance : placed)
    if (const auto* mesh = std::get_if<TriangleMesh>(&desc.geometries[instance.geometry.value].shapes))
      vertices += mesh->positions.size(), triangles += mesh->indices.size();
  if (vertices > std::numeric_limits<std::uint32_t>::max())
    throw std::invalid_argument(fmt::format(
        "scene: {} vertices in all instances, the bench takes at most 2^32", with_commas(vertices)));
  flat.mesh.positions.reserve(vertices + 1);
  flat.mesh.indices.reserve(triangles);

  for (const Instance& instance : placed) {
    const Geometry& geometry = desc.geometries[instance.geometry.value];
    const auto* mesh = std::get_if<TriangleMesh>(&geometry.shapes);
    if (!mesh) {
      flat.left_out += primitive_count(geometry);
      continue;
    }
    const auto first = static_cast<std::uint32_t>(flat.mesh.positions.size());
    const bool stays = instance.world_from_object == Affine3::identity();
    for (const Vec3& p : mesh->positions)
      flat.mesh.positions.push_back(stays ? p : instance.world_from_object.point(p));
    for (const auto& [a, b, c] : mesh->indices)
      flat.mesh.indices.push_back({first + a, first + b, first + c});
  }
  return flat;
}

std::string difference(const Answers& ours, const Answers& theirs) {
  const double hits = std::fabs(double(ours.hits) - double(theirs.hits));
  if (hits > kTolerance * double(ours.hits) + kEdgeCases)
    return fmt::format("{} hits, Boxwood has {}", with_commas(theirs.hits), with_commas(ours.hits));
  const double sum = std::fabs(ours.checksum - theirs.checksum);
  if (!(sum <= kTolerance * ours.checksum + kEdgeCases * std::max(ours.largest_t, theirs.largest_t)))
    return fmt::format("t sums to {:.9g}, Boxwood's to {:.9g}", theirs.checksum, ours.checksum);
  return "";
}

BenchReport bench(const std::vector<std::string>& scenes, const std::vector<std::unique_ptr<Engine>>& engines,
                  const BenchOptions& options, const std::function<SceneDesc(const std::string&)>& open,
                  const Progress& progress) {
  Bench bench(engines, options, progress);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (progress && !progress(short_name(scenes[i]) + ": reading", double(i) / double(scenes.size())))
      throw Cancelled();
    bench.measure(scenes[i], i, scenes.size(), open(scenes[i]));
  }
  BenchReport report = bench.take_report();
  if (report.builds.empty())
    throw std::invalid_argument(
        fmt::format("{} has no triangles, and the bench compares only those", fmt::join(scenes, ", ")));
  return report;
}

}  // namespace boxwood::app
