// surface_block_test.cpp: do many hits at once have the surfaces that each has alone, bit for bit?
#include "boxwood/scene/surface_block.h"

#include <numeric>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"

namespace boxwood {
namespace {

/// Triangles around the origin, with what their corners may hold: normals of any length, also none, and
/// texture coordinates that cover no area.
TriangleMesh triangles(Random& random, bool with_normals, bool with_uvs) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const Vec3 at = random.direction() * 3;
    for (int k = 0; k < 3; ++k) {
      mesh.positions.push_back(at + random.direction() * (i % 10 == 0 ? 1e-3f : 1.0f));
      const float length = i % 7 == 0 ? 0.0f : i % 5 == 0 ? 1e-30f : 1.0f;
      if (with_normals) mesh.normals.push_back(random.direction() * length);
      if (with_uvs) mesh.uvs.push_back({random.uniform(), i % 4 == 0 ? 0.5f : random.uniform()});
    }
    mesh.indices.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TEST(SurfaceBlock, SurfacesAreThoseOfEachHit) {
  Random random(12);
  SceneDesc desc;
  const MaterialId red = desc.add(Material{}), green = desc.add(Material{});
  for (const bool with_normals : {false, true})
    for (const bool with_uvs : {false, true}) {
      const GeometryId mesh = desc.add(triangles(random, with_normals, with_uvs), red);
      desc.add(Instance{mesh, {}, {}});
      desc.add(Instance{mesh, Affine3::translation({0.5f, 0, 0}), green});
    }
  TriangleMesh twice_mapped = triangles(random, true, true);
  twice_mapped.second_uvs = triangles(random, true, true).uvs;
  const GeometryId twice = desc.add(std::move(twice_mapped), red);
  desc.add(Instance{twice, {}, {}});
  desc.add(Instance{twice, Affine3::scale(1.5f), {}});
  Geometry patchwork{triangles(random, true, true), red, {}, {}};
  for (int i = 0; i < 60; ++i) patchwork.materials.push_back(i % 2 ? red : green);
  desc.add(Instance{desc.add(patchwork), {}, {}});
  desc.add(Instance{desc.add(patchwork), {}, green});
  desc.add(Instance{desc.add(std::vector<Sphere>{{{1, 1, 1}, 0.6f}, {{-1, 1, 2}, 0.4f}}, green), {}, {}});
  desc.add(Instance{desc.add(std::vector<Quad>{{{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}}}), {}, {}});
  const Scene scene(std::move(desc));
  const SurfaceReader reader(scene);

  std::vector<Ray> rays;
  std::vector<Hit> hits;
  while (rays.size() < 4000) {
    const Ray ray{random.direction() * 8, 0, random.direction()};
    const Hit hit = scene.closest_hit(ray);
    if (!hit) continue;
    rays.push_back(ray);
    hits.push_back(hit);
  }
  std::vector<std::uint32_t> order(rays.size());
  std::iota(order.rbegin(), order.rend(), 0u);
  SurfaceBlock block;
  std::size_t smooth = 0, mapped = 0, mapped_twice = 0;
  for (std::size_t first = 0; first < order.size();) {
    // Blocks that are full, and others.
    const std::size_t count = std::min<std::size_t>(kBlock - first % 3, order.size() - first);
    const std::span which = std::span(order).subspan(first, count);
    for (const std::uint32_t i : which) reader.prefetch_triangle(hits[i]);
    for (const std::uint32_t i : which) reader.prefetch_corners(hits[i]);
    reader.read(rays, hits, which, block);
    for (std::size_t i = 0; i < count; ++i) {
      const Surface expected = surface_at(scene, rays[which[i]], hits[which[i]]);
      const Surface found = block[static_cast<int>(i)];
      EXPECT_EQ(found.position, expected.position);
      EXPECT_EQ(found.error, expected.error);
      EXPECT_EQ(found.normal, expected.normal);
      EXPECT_EQ(found.shading_normal, expected.shading_normal);
      EXPECT_EQ(found.uv, expected.uv);
      EXPECT_EQ(found.second_uv, expected.second_uv);
      EXPECT_EQ(found.material, expected.material);
      EXPECT_EQ(block.clearance[i], expected.clearance());
      EXPECT_EQ(block.uv_density[i], uv_density(scene, hits[which[i]]));
      EXPECT_EQ(block.second_uv_density[i], uv_density(scene, hits[which[i]], true));
      smooth += found.shading_normal != found.normal;
      mapped += block.uv_density[i] > 0;
      mapped_twice += found.second_uv != found.uv;
    }
    first += count;
  }
  EXPECT_GT(smooth, 100u);
  EXPECT_GT(mapped, 100u);
  EXPECT_GT(mapped_twice, 100u);
  EXPECT_LT(mapped, rays.size() - 100);
}

}  // namespace
}  // namespace boxwood
