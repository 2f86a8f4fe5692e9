// bench.h: how fast is Boxwood beside its peers, on the same scenes and the same rays, in one run?
//
// All engines work in one process and take turns, measurement by measurement, so that whatever else the
// machine does hits all alike; medians over the rounds count. Every answer is compared: within Boxwood to the
// last bit, with peers within stated bounds.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bench_engine.h"
#include "bench_rays.h"
#include "boxwood/core/progress.h"

namespace boxwood::app {

struct BenchOptions {
  std::vector<std::string> sets{std::begin(kRaySetNames), std::end(kRaySetNames)};
  std::vector<int> threads{1};  ///< Each is measured; none twice.
  int repetitions = 5;
  std::size_t rays_per_set = 512 * 512;
  std::vector<RaySet> own_sets;  ///< Users' rays, asked of every scene besides.
};

/// Rays through the tree of the engine's traced preset.
struct RateReport {
  std::string scene, engine, mode, set;
  int threads = 1;
  double mrays_per_s = 0;  ///< Median over the repetitions.
  Answers answers;
};

/// The same, ray by ray and on the first number of threads, through the trees of the engine's other presets.
struct PresetReport : RateReport {
  std::string preset;
};

/// Boxwood's batch of bounce1 on the first number of threads, cut into calls of `size` rays.
struct BatchSizeReport : RateReport {
  std::size_t size = 0;
};

struct BuildReport {
  std::string scene, engine, preset;
  int threads = 1;
  double build_ms = 0;  ///< Median.
  double bytes_per_triangle = 0;
};

struct BenchScene {
  std::string name;
  std::size_t triangles = 0;  ///< 0: nothing to measure, so no figures.
  std::size_t left_out = 0;   ///< Other shapes.
};

struct BenchReport {
  std::string machine;
  BenchOptions options;
  std::vector<std::string> engines;  ///< Boxwood, then its peers.
  std::vector<BenchScene> scenes;
  std::vector<RateReport> rates;
  std::vector<PresetReport> trees;
  std::vector<BatchSizeReport> batch_sizes;
  std::vector<BuildReport> builds;
  std::vector<std::string> disagreements;  ///< A sentence each; empty when all answers agree.
};

/// A scene as summaries and charts call it: a file's stem and the folder it is in ("kitchen/scene").
std::string short_name(const std::string& scene);

/// The triangles of everything that `desc` places, in world space, as one mesh; and how many other shapes
/// were left out. Throws std::invalid_argument as check(desc) does, and for more than 2^32 vertices.
struct FlatMesh {
  TriangleMesh mesh;
  std::size_t left_out = 0;
};
FlatMesh flatten_triangles(const SceneDesc& desc);

/// Why `theirs` is not the answer that `ours` is; empty when it is. Hits may differ by one in 10,000 and by
/// two more, checksums by one part in 10,000 and by what two hits contribute at most: peers round otherwise,
/// and may lose or find a ray at an edge.
std::string difference(const Answers& ours, const Answers& theirs);

/// Measures one scene after the other with every engine; the first is Boxwood. `open(name)` reads a scene.
/// `progress` is told how far it is; when it returns false, Cancelled is thrown. Throws std::invalid_argument
/// when no scene has triangles.
BenchReport bench(const std::vector<std::string>& scenes, const std::vector<std::unique_ptr<Engine>>& engines,
                  const BenchOptions& options, const std::function<SceneDesc(const std::string&)>& open,
                  const Progress& progress);

}  // namespace boxwood::app
