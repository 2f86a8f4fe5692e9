// query_bench: how many questions a second does one thread answer, by question and by shape?
#include <map>
#include <string>

#include "boxwood/boxwood.h"
#include "workload.h"

namespace boxwood::bench {
namespace {

/// A tree over shapes that stand in leaf order, as a careful user would keep them.
template <class Shape>
struct Ordered {
  Bvh bvh;
  std::vector<Shape> shapes;

  explicit Ordered(const std::vector<Shape>& input) : bvh(build(boxes(input), BuildOptions::best())) {
    for (PrimId& id : bvh.prim_ids) {
      shapes.push_back(input[id.value]);
      id = PrimId(shapes.size() - 1);
    }
  }
};

const Ordered<Triangle>& terrain() {
  static const Ordered<Triangle> tree(triangles("terrain:512"));
  return tree;
}
const Ordered<Triangle>& soup() {
  static const Ordered<Triangle> tree(triangles("soup:100000"));
  return tree;
}
const Ordered<Sphere>& balls() {
  static const Ordered<Sphere> tree(spheres());
  return tree;
}

template <class Tree>
void closest(benchmark::State& state, const Tree& (*make)()) {
  const auto& [bvh, shapes] = make();
  measure_rays(state, mixed_rays(bvh.bounds(), kRays),
               [&](const Ray& ray) { return closest_hit(bvh, shapes, ray).t; });
}

template <class Tree>
void any(benchmark::State& state, const Tree& (*make)()) {
  const auto& [bvh, shapes] = make();
  measure_rays(state, shadow_rays(bvh.bounds(), kRays),
               [&](const Ray& ray) { return any_hit(bvh, shapes, ray) ? 1.0f : kInfinity; });
}

template <class Tree>
void all(benchmark::State& state, const Tree& (*make)()) {
  const auto& [bvh, shapes] = make();
  std::vector<ShapeHit> hits;
  measure_rays(state, mixed_rays(bvh.bounds(), kRays / 16), [&](const Ray& ray) {
    all_hits(bvh, shapes, ray, hits);
    return hits.empty() ? kInfinity : hits.back().t;
  });
}

/// The rays' origins serve as points.
template <class Tree>
void point(benchmark::State& state, const Tree& (*make)()) {
  const auto& [bvh, shapes] = make();
  measure_rays(state, mixed_rays(bvh.bounds(), kRays / 16),
               [&](const Ray& ray) { return closest_point(bvh, shapes, ray.origin).distance; });
}

BENCHMARK_CAPTURE(closest, terrain, terrain)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(closest, soup, soup)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(closest, spheres, balls)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(any, terrain, terrain)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(any, soup, soup)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(any, spheres, balls)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(all, terrain, terrain)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(all, spheres, balls)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(point, terrain, terrain)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(point, spheres, balls)->Unit(benchmark::kMillisecond);

/// The same question through the hall, where kernels answer: one ray at a time, and all at once.
const Scene& scene(const char* name) {
  static std::map<std::string, Scene> made;
  if (const auto at = made.find(name); at != made.end()) return at->second;
  SceneDesc desc;
  TriangleMesh mesh;
  for (const Triangle& t : triangles(name)) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {t.a, t.b, t.c});
    mesh.indices.push_back({first, first + 1, first + 2});
  }
  desc.add(std::move(mesh));
  return made.emplace(name, Scene(std::move(desc), BuildOptions::best())).first->second;
}

void scene_closest(benchmark::State& state, const char* name) {
  const Scene& hall = scene(name);
  measure_rays(state, mixed_rays(hall.bounds(), kRays),
               [&](const Ray& ray) { return hall.closest_hit(ray).t; });
}

void scene_batch(benchmark::State& state, const char* name) {
  const Scene& hall = scene(name);
  const std::vector<Ray> rays = mixed_rays(hall.bounds(), kRays);
  std::vector<Hit> hits(rays.size());
  for (auto _ : state) hall.closest_hit(rays, hits, &serial_executor());
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * rays.size()));
  report_hits(state, rays.size(), [&](std::size_t i) { return hits[i].t; });
}

BENCHMARK_CAPTURE(scene_closest, terrain, "terrain:512")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scene_closest, soup, "soup:100000")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scene_batch, terrain, "terrain:512")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scene_batch, soup, "soup:100000")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace boxwood::bench
