// threads_test.cpp: may many threads build and ask at once?
//
// Some threads build scenes with every preset, all on the same executor, and ask what they have built; others
// ask one scene that is shared, ray by ray and in batches. Everybody gets the answers of a thread that is
// alone. What a thread sanitizer has to say is said here.
#include <thread>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/gallery/gallery.h"
#include "boxwood/scene/scene.h"

namespace boxwood {
namespace {

/// Triangles, spheres and placements.
SceneDesc description(int kind) {
  return gallery::make(kind % 3 == 0 ? "soup:3000" : kind % 3 == 1 ? "city:60" : "stilllife");
}

std::vector<Ray> rays_for(const Scene& scene, std::size_t count) {
  Random random(5);
  const Box3 bounds = scene.bounds();
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 from = random.in_box(bounds.lower, bounds.upper);
    rays.push_back({from, 0, random.in_box(bounds.lower, bounds.upper) - from, kInfinity});
  }
  rays[count / 2].origin.x = 1e30f;  // one for plain C++
  return rays;
}

/// The number of wrong answers.
std::size_t ask(const Scene& scene, std::span<const Ray> rays, std::span<const Hit> expected,
                Executor& executor) {
  std::size_t wrong = 0;
  std::vector<Hit> hits(rays.size());
  const std::unique_ptr<bool[]> is_hit(new bool[rays.size()]);
  scene.closest_hit(rays, hits, &executor);
  scene.any_hit(rays, std::span(is_hit.get(), rays.size()), &executor);
  for (std::size_t i = 0; i < rays.size(); ++i)
    wrong += hits[i] != expected[i] || is_hit[i] != expected[i].is_hit();
  for (std::size_t i = 0; i < rays.size(); i += 8) {
    wrong += scene.closest_hit(rays[i]) != expected[i] || scene.any_hit(rays[i]) != expected[i].is_hit();
    scene.all_hits(rays[i], hits);
    wrong += (hits.empty() ? Hit{} : hits[0]) != expected[i] || scene.count_hits(rays[i]) != hits.size();
  }
  return wrong;
}

std::vector<Hit> answers(const Scene& scene, std::span<const Ray> rays) {
  std::vector<Hit> hits;
  for (const Ray& ray : rays) hits.push_back(scene.closest_hit(ray));
  return hits;
}

TEST(Threads, BuildAndAskAtOnce) {
  constexpr int kBuilders = 4, kAskers = 4;
  const std::unique_ptr<Executor> executor = make_executor(3);
  const BuildOptions presets[] = {BuildOptions::fast(), BuildOptions::balanced(), BuildOptions::best()};

  // Alone.
  const Scene shared(description(0));
  const std::vector<Ray> rays = rays_for(shared, 2000);
  const std::vector<Hit> expected = answers(shared, rays);
  std::vector<std::vector<Ray>> own_rays;
  std::vector<std::vector<Hit>> own_expected;
  for (int kind = 0; kind < 3; ++kind) {
    const Scene scene(description(kind));
    own_rays.push_back(rays_for(scene, 1000));
    own_expected.push_back(answers(scene, own_rays.back()));
  }

  // All at once.
  std::array<std::size_t, kBuilders + kAskers> wrong{};
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < kBuilders; ++k)
    threads.emplace_back([&, k] {
      for (std::size_t round = 0; round < 3; ++round) {
        BuildOptions options = presets[round];
        options.executor = executor.get();
        const std::size_t kind = (k + round) % 3;
        const Scene scene(description(static_cast<int>(kind)), options);
        wrong[k] += ask(scene, own_rays[kind], own_expected[kind], *executor);
      }
    });
  for (std::size_t k = kBuilders; k < kBuilders + kAskers; ++k)
    threads.emplace_back([&, k] {
      for (int round = 0; round < 3; ++round)
        wrong[k] += ask(shared, rays, expected, k % 2 ? *executor : serial_executor());
    });
  for (std::thread& thread : threads) thread.join();
  for (const std::size_t count : wrong) EXPECT_EQ(count, 0u);
}

}  // namespace
}  // namespace boxwood
