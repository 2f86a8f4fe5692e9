// clouds.cpp: scenes of N random primitives in a cube, made to be measured:
// spheres, triangle soup, and the worst case.
//
// A cell is the cube's share of space for one primitive, 2 / cbrt(N) wide. Sizes are a multiple of it, so a
// picture and a tree look alike for 100 primitives and for ten million. The multiple follows Pareto's law, 1
// / sqrt(uniform): most are small and a few are huge, which is what makes builders earn their keep.

#include "boxwood/gallery/makers.h"

namespace boxwood::gallery {

namespace {

double cell_width(std::uint64_t count) {
  return 2 / cube_root(double(count));
}

/// `smallest` or more; twice that on average; above x with probability (smallest / x)^2; cut off at
/// `largest`.
float heavy_tail(Random& random, double smallest, float largest) {
  return min(float(smallest / std::sqrt(1 - double(random.uniform()))), largest);
}

void frame_cube(SceneDesc& desc) {
  desc.camera = look_at_camera({2.3f, 1.7f, 3.9f}, {0, -0.03f, 0}, 33, 960, 720);
  desc.sky = clear_sky({0.6f, 1, 0.45f});
  desc.sky->ground = {0.40f, 0.44f, 0.50f};  // what most of the picture is seen against
}

}  // namespace

SceneDesc make_spheres(std::uint64_t count) {
  SceneDesc desc;
  const std::vector<MaterialId> palette = add_palette(desc);
  Random random(count, 1);
  const double cell = cell_width(count);

  std::vector<Sphere> spheres(count);
  std::vector<MaterialId> materials(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    spheres[i].radius = heavy_tail(random, 0.16 * cell, 0.4f);
    const float room = 1 - spheres[i].radius;
    spheres[i].center = random.in_box(splat(-room), splat(room));
    materials[i] = palette[random.below(std::uint32_t(palette.size()))];
  }
  desc.add(Geometry{std::move(spheres), {}, std::move(materials), "spheres"});
  frame_cube(desc);
  return desc;
}

SceneDesc make_soup(std::uint64_t count) {
  SceneDesc desc;
  const std::vector<MaterialId> palette = add_palette(desc);
  Random random(count, 2);
  const double cell = cell_width(count);

  TriangleMesh mesh;
  mesh.positions.reserve(3 * count);
  mesh.indices.reserve(count);
  std::vector<MaterialId> materials(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const float size = heavy_tail(random, 0.25 * cell, 0.5f);
    const float room = 1 - size;
    const Vec3 center = random.in_box(splat(-room), splat(room));
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back(center + in_unit_ball(random) * size);
    mesh.indices.push_back({first, first + 1, first + 2});
    materials[i] = palette[random.below(std::uint32_t(palette.size()))];
  }
  desc.add(Geometry{std::move(mesh), {}, std::move(materials), "soup"});
  frame_cube(desc);
  return desc;
}

SceneDesc make_duplicates(std::uint64_t count) {
  SceneDesc desc;
  const MaterialId coral = add_palette(desc)[0];
  TriangleMesh mesh;
  mesh.positions = {{-1, -0.8f, 0}, {1, -0.8f, 0.3f}, {0, 0.9f, -0.2f}};
  mesh.indices.assign(count, {0, 1, 2});
  desc.add(Geometry{std::move(mesh), coral, {}, "duplicates"});
  frame_cube(desc);
  return desc;
}

}  // namespace boxwood::gallery
