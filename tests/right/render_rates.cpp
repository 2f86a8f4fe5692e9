// render_rates.cpp: how many of the rays that a scene can be asked in a second does a picture of it get?
//
//   render_rates SCENE [THREADS [ROUNDS]]
//
// A renderer traces, and between its rays it shades. Measured in turns, in one process, medians of the
// rounds: rays of the sets of `boxwood bench`, as batches and one by one, and small pictures. The rate to be
// expected of a picture that only traced is the harmonic mean of the sets' rates, weighed by the kinds of
// rays that its paths consist of; a half of the bounces counts as bounce1, the other as bounce2.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>

#include "bench_rays.h"
#include "boxwood/io/load.h"
#include "boxwood/render/camera.h"
#include "boxwood/render/path.h"
#include "boxwood/render/render.h"
#include "boxwood_engine.h"
#include "scene_source.h"

using namespace boxwood;

namespace {

constexpr int kWidth = 320, kHeight = 180, kSamples = 32;
constexpr std::size_t kRaysPerSet = 512 * 512;

/// Of the processor, all threads together: what other programs do matters less.
double seconds_of(const auto& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// The kinds of rays of the paths through every fourth pixel of every fourth row.
struct Kinds {
  double camera = 0, bounce = 0, shadow = 0;
  double total() const { return camera + bounce + shadow; }
};
Kinds kinds_of(const Scene& scene) {
  const Camera camera = render::choose_camera(scene.description(), kWidth, kHeight);
  const render::Lens lens(camera, kWidth, kHeight);
  const auto tracer = render::make_path_tracer(scene, camera);
  std::vector<Ray> rays;
  std::vector<render::Sampler> samplers;
  for (int y = 0; y < kHeight; y += 4)
    for (int x = 0; x < kWidth; x += 4) {
      render::Sampler sampler(static_cast<std::uint32_t>(y * kWidth + x), 0);
      const Vec2 place = sampler.next_2d();
      rays.push_back(lens.ray({float(x) + place.x, float(y) + place.y}, sampler.next_2d()));
      samplers.push_back(sampler);
    }
  std::vector<float> values(3 * rays.size());
  const auto is_counted = std::make_unique<bool[]>(rays.size());
  std::vector<render::RayCounts> counts(rays.size());
  tracer->sample_many(rays, samplers, values, {is_counted.get(), rays.size()}, counts);
  Kinds kinds;
  for (const render::RayCounts& count : counts) {
    kinds.camera += count.camera;
    kinds.bounce += count.bounce;
    kinds.shadow += count.shadow;
  }
  return kinds;
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 2 || count > 4) {
    std::fprintf(stderr, "render_rates SCENE [THREADS [ROUNDS]]\n");
    return 2;
  }
  const int threads = count > 2 ? std::atoi(arguments[2]) : 0;
  const int rounds = count > 3 ? std::max(1, std::atoi(arguments[3])) : 5;
  const auto executor = make_executor(threads);
  const Scene scene(io::load(arguments[1], executor.get()));
  const std::vector<app::RaySet> sets = app::make_ray_sets(
      scene, scene.description(), kRaysPerSet, {"primary", "occlusion", "bounce1", "bounce2"}, *executor);

  std::map<std::string, std::vector<double>> batch, single;
  std::vector<double> pictures;
  std::vector<Hit> hits(2 * kRaysPerSet);
  const auto is_hit = std::make_unique<bool[]>(2 * kRaysPerSet);
  for (int round = 0; round < rounds; ++round) {
    for (const app::RaySet& set : sets) {
      const std::span<const Ray> rays = set.rays;
      const bool is_any = set.question == app::Question::any_hit;
      const double together = seconds_of([&] {
        if (is_any)
          scene.any_hit(rays, {is_hit.get(), rays.size()}, executor.get());
        else
          scene.closest_hit(rays, std::span(hits).first(rays.size()), executor.get());
      });
      const double apart = seconds_of([&] {
        executor->for_range(0, rays.size(), 1024, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i)
            if (is_any)
              is_hit[i] = scene.any_hit(rays[i]);
            else
              hits[i] = scene.closest_hit(rays[i]);
        });
      });
      batch[set.name].push_back(static_cast<double>(rays.size()) * 1e-6 / together);
      single[set.name].push_back(static_cast<double>(rays.size()) * 1e-6 / apart);
    }
    render::RenderOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.samples = kSamples;
    options.executor = executor.get();
    std::uint64_t traced = 0;
    const double seconds = seconds_of([&] { traced = render::render_picture(scene, options).rays; });
    pictures.push_back(static_cast<double>(traced) * 1e-6 / seconds);
  }

  const Kinds kinds = kinds_of(scene);
  const double camera = kinds.camera / kinds.total(), bounce = kinds.bounce / kinds.total(),
               shadow = kinds.shadow / kinds.total();
  const auto expected = [&](const std::map<std::string, std::vector<double>>& rates) {
    const auto rate = [&](const char* set) { return median(rates.at(set)); };
    return 1 / (camera / rate("primary") + 0.5 * bounce / rate("bounce1") + 0.5 * bounce / rate("bounce2") +
                shadow / rate("occlusion"));
  };
  std::printf("%-12s %10s %10s   million rays a second of the processor, %d threads\n", "rays", "batch",
              "single", executor->concurrency());
  for (const app::RaySet& set : sets)
    std::printf("%-12s %10.2f %10.2f\n", set.name.c_str(), median(batch[set.name]), median(single[set.name]));
  std::printf("%-12s %10.2f %10.2f   %.0f%% camera, %.0f%% bounce, %.0f%% shadow\n", "weighed",
              expected(batch), expected(single), 100 * camera, 100 * bounce, 100 * shadow);
  std::printf("%-12s %10.2f               %.0f%% of batch, %.0f%% of single\n", "picture", median(pictures),
              100 * median(pictures) / expected(batch), 100 * median(pictures) / expected(single));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "render_rates: %s\n", error.what());
  return 1;
}
