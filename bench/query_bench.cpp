// query_bench: how many questions a second does one thread answer, by question and by shape?
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

/// The same question through the hall, where a scene keeps its shapes itself.
void scene_closest(benchmark::State& state) {
  SceneDesc desc;
  TriangleMesh mesh;
  for (const Triangle& t : triangles("terrain:512")) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {t.a, t.b, t.c});
    mesh.indices.push_back({first, first + 1, first + 2});
  }
  desc.add(std::move(mesh));
  const Scene scene(std::move(desc), BuildOptions::best());
  measure_rays(state, mixed_rays(scene.bounds(), kRays),
               [&](const Ray& ray) { return scene.closest_hit(ray).t; });
}
BENCHMARK(scene_closest)->Name("closest/terrain_as_scene")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace boxwood::bench
