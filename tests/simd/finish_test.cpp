// finish_test.cpp: do the weights and the normals of a batch, and of one ray, have the bits of the scalar
// ones?
#include <cmath>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/core/random.h"
#include "kernel_oracle.h"
#include "support/meshes.h"
#include "support/shapes.h"

namespace boxwood::simd {
namespace {

/// Rays of ordinary directions at triangles within `scale` of the origin; a few miss.
std::vector<Ray> rays_at(const std::vector<Triangle>& triangles, std::size_t count, float scale) {
  Random random(count);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Triangle& t = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
    const float u = random.uniform(0, 0.6f), v = random.uniform(0, 0.5f);
    // Corners and points of edges too, where a weight is 0.
    const std::uint32_t where = random.below(12);
    const Vec3 to = where == 0   ? t.b
                    : where == 1 ? t.a
                    : where == 2 ? t.a + (t.b - t.a) * 0.5f
                    : where == 3 ? t.a + (t.c - t.a) * 0.5f
                                 : t.a + (t.b - t.a) * u + (t.c - t.a) * v;
    const Vec3 from = random.in_box(splat(-2), splat(2)) * scale;
    Vec3 way = (to - from) * (1 / scale);
    if (random.below(5) == 0) {
      way = {0, -0.0f, 0};
      way[static_cast<int>(random.below(3))] = random.below(2) ? 1.0f : -1.0f;
    }
    if (max_component(abs(way)) > 1e-3f)
      rays.push_back({random.below(5) ? from : to - way * scale, 0, way, kInfinity});
  }
  return rays;
}

void expect_finished_right(const std::string& name, const std::vector<Triangle>& triangles, float scale) {
  SCOPED_TRACE(name);
  const Bvh bvh = build(boxes(triangles));
  for (const Kernels* kernels : available_kernels())
    for (const Layout layout : test::kLayouts) {
      const auto tree = test::pack(kernels->width, bvh, triangles, {}, layout);
      for (const std::size_t count : {0, 1, 7, 63, 64, 65, 128, 5000}) {
        const std::vector<Ray> rays = rays_at(triangles, count, scale);
        std::vector<TriangleHit> found(count);
        std::vector<std::uint32_t> unusual;
        kernels->closest_hits(*tree, rays, bvh.bounds(), found.data(), nullptr, unusual);
        ASSERT_TRUE(unusual.empty());
        std::vector<Hit> hits(count);
        kernels->finish_hits(*tree, rays, found.data(), hits.data());

        std::size_t hit_count = 0, wrong = 0;
        for (std::size_t i = 0; i < count; ++i) {
          if (!found[i].is_hit()) {
            wrong += !(hits[i] == Hit{});
            continue;
          }
          ++hit_count;
          const Triangle& triangle = triangles[found[i].key];
          const RayShear shear(rays[i].origin, rays[i].direction);
          Crossing crossing;
          ASSERT_TRUE(intersect_triangle(shear, triangle.a, triangle.b, triangle.c, crossing));
          const Vec3 normal = triangle.normal();
          bool is_right = test::same_bits(hits[i].t, found[i].t) && test::same_bits(hits[i].u, crossing.u) &&
                          test::same_bits(hits[i].v, crossing.v);
          for (int k = 0; k < 3; ++k) is_right &= test::same_bits(hits[i].normal[k], normal[k]);
          wrong += !is_right;
          TriangleHit one;
          Hit full;
          ASSERT_TRUE(kernels->closest_full_hit(*tree, rays[i], bvh.bounds(), one, full));
          wrong += one.key != found[i].key || !(full == hits[i]) || !test::same_bits(full.u, crossing.u) ||
                   !test::same_bits(full.v, crossing.v);
        }
        EXPECT_EQ(wrong, 0u) << kernels->name << ", " << count << " rays";
        EXPECT_GE(hit_count, count / 4) << "the rays are too easy";
      }
    }
}

TEST(KernelFinish, WeightsAndNormalsHaveTheBitsOfTheScalarOnes) {
  const auto placed = [](const boxwood::test::Mesh& mesh, float scale) {
    return boxwood::test::triangles(boxwood::test::placed(mesh, scale, {0, 0, 0}));
  };
  expect_finished_right("soup", placed(boxwood::test::triangle_soup(3000), 1), 1);
  expect_finished_right("rough sphere", placed(boxwood::test::rough_sphere(3), 1), 1);
  expect_finished_right("cube", placed(boxwood::test::cube(3), 1), 1);
  // Here the sums of weights leave what float can say, and double decides.
  expect_finished_right("tiny", placed(boxwood::test::rough_sphere(2), 1e-15f), 1e-15f);
  expect_finished_right("large", placed(boxwood::test::rough_sphere(2), 1e8f), 1e8f);
}

}  // namespace
}  // namespace boxwood::simd
