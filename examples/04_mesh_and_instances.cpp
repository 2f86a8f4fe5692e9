// 04_mesh_and_instances: how does one mesh stand in many places? Describe a scene, build it, ask it.
#include <cstdio>

#include <boxwood/boxwood.h>

using namespace boxwood;

int main() {
  // A pyramid: five corners, shared by six triangles. No padding, no alignment, no special types.
  TriangleMesh pyramid{.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}, {0, 2, 0}},
                       .indices = {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}}};

  // The mesh is kept once; each instance is a transform and costs a few bytes.
  SceneDesc desc;
  const GeometryId mesh = desc.add(std::move(pyramid));
  for (int i = 0; i < 1000; ++i)
    desc.add(
        Instance{mesh, Affine3::translation({4.0f * static_cast<float>(i), 0, 0}) * Affine3::scale(1.5f)});

  // Built here, read-only from now on: any number of threads may ask it.
  const Scene scene(std::move(desc), BuildOptions::balanced());

  // Look down onto the row, beside the tip of instance 42.
  const Ray ray{.origin = {168.5f, 10, 0.1f}, .direction = {0, -1, 0}};
  const Hit hit = scene.closest_hit(ray);
  std::printf("instance %u, triangle %u, at t = %.3f\n", hit.instance_id.value, hit.primitive_id.value,
              hit.t);

  const SceneStatistics statistics = scene.statistics();
  std::printf("%zu triangles are shown, %zu trees were built\n", statistics.primitives, statistics.trees);
}
