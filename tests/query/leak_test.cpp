// leak_test.cpp: can a ray slip through a closed mesh?
//
// About a million rays are aimed at the vertices and edges of closed meshes, from inside and from outside, at
// the origin and thousands of units from it; ten million when BOXWOOD_LONG_TESTS is 1. From inside every ray
// must hit; counted as -1 where it enters and +1 where it leaves, its crossings must sum to 1 from inside and
// to 0 from outside, which a crossing that is lost or found twice upsets. The usual triangle test, on the
// same rays, shows that they are hard enough.
#include <atomic>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/core/random.h"
#include "boxwood/query/all_hits.h"
#include "boxwood/query/any_hit.h"
#include "boxwood/query/closest_hit.h"
#include "boxwood/query/group.h"
#include "boxwood/shape/instance.h"
#include "support/leak_rays.h"

namespace boxwood {
namespace {

using test::aim;
using test::AimedRay;
using test::bodies;
using test::Body;
using test::crossing_sign;
using test::kOffsets;

std::size_t ray_budget() {
  const char* wish = std::getenv("BOXWOOD_LONG_TESTS");
  return wish && std::string(wish) == "1" ? 10'000'000 : 1'000'000;
}

struct Count {
  std::atomic<std::size_t> rays = 0, leaks = 0, miscounted = 0, disagreements = 0, crossings = 0;
};

/// Traces `count` rays at the body in parallel and adds up what went wrong. `Shape` is made from a Triangle.
template <class Shape>
void trace(const test::Mesh& mesh, Vec3 inside, float clearance, float size, std::size_t count,
           Count& result) {
  const std::vector<Triangle> triangles = test::triangles(mesh);
  const std::vector<Shape> shapes(triangles.begin(), triangles.end());
  const Bvh bvh = build(boxes(shapes));

  constexpr std::size_t kBlock = 1000;
  parallel_for(default_executor(), 0, (count + kBlock - 1) / kBlock, 1, [&](std::size_t block) {
    Random random(1, block);
    std::vector<ShapeHit> hits;
    std::size_t leaks = 0, miscounted = 0, disagreements = 0, crossings = 0;
    for (std::size_t i = 0; i < kBlock; ++i) {
      const auto [ray, starts_inside, must_hit] = aim(mesh, inside, clearance, size, random);
      const ShapeHit first = closest_hit(bvh, shapes, ray);
      all_hits(bvh, shapes, ray, hits);
      leaks += must_hit && !first.is_hit();
      disagreements += any_hit(bvh, shapes, ray) != first.is_hit();
      disagreements += !(first == (hits.empty() ? ShapeHit{} : hits.front()));
      crossings += hits.size();

      const PreparedRay prepared(ray, bvh.bounds());
      int sum = 0;
      for (const ShapeHit& hit : hits) sum += crossing_sign(prepared, triangles[hit.prim_id.value]);
      miscounted += sum != int(starts_inside) || hits.size() % 2 != std::size_t(starts_inside);
    }
    result.rays += kBlock;
    result.leaks += leaks;
    result.miscounted += miscounted;
    result.disagreements += disagreements;
    result.crossings += crossings;
  });
}

/// Every body at every offset.
template <class Shape>
void trace_everything(std::size_t budget, Count& total, bool expect_none) {
  for (const Body& body : bodies())
    for (const Vec3 offset : kOffsets) {
      Count here;
      const test::Mesh mesh = test::placed(body.mesh, 1, offset);
      trace<Shape>(mesh, body.inside + offset, body.clearance, 2,
                   budget / (bodies().size() * std::size(kOffsets)), here);
      total.rays += here.rays;
      total.leaks += here.leaks;
      total.miscounted += here.miscounted;
      total.disagreements += here.disagreements;
      total.crossings += here.crossings;
      if (!expect_none) continue;
      EXPECT_EQ(here.leaks, 0u) << body.name << " at " << offset.x;
      EXPECT_EQ(here.miscounted, 0u) << body.name << " at " << offset.x;
      EXPECT_EQ(here.disagreements, 0u) << body.name << " at " << offset.x;
    }
}

TEST(Leaks, TheMeshesAreClosed) {
  for (const Body& body : bodies()) EXPECT_TRUE(test::is_closed(body.mesh)) << body.name;
  EXPECT_FALSE(test::is_closed(test::triangle_soup(3)));
  EXPECT_EQ(test::sponge(3).indices.size(), 36096u);
}

TEST(Leaks, NoRayGetsThroughAndEachCrossingCountsOnce) {
  Count total;
  trace_everything<Triangle>(ray_budget(), total, true);
  EXPECT_GT(total.rays, ray_budget() * 9 / 10);
  EXPECT_GT(total.crossings, total.rays);
  RecordProperty("rays", std::to_string(total.rays));
}

TEST(Leaks, NoneAtAnyScale) {
  for (float scale : {1e-25f, 1e-10f, 1e10f, 1e25f})
    for (const Body& body : bodies()) {
      Count here;
      trace<Triangle>(test::placed(body.mesh, scale, {0, 0, 0}), body.inside * scale, body.clearance * scale,
                      2 * scale, 5000, here);
      EXPECT_EQ(here.leaks + here.miscounted + here.disagreements, 0u) << body.name << " scaled by " << scale;
    }
}

/// The usual test of Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997: every
/// triangle rounds for itself, so two that share an edge need not agree on which side of it a ray passes.
struct UsualTriangle : Triangle {
  UsualTriangle(const Triangle& triangle) : Triangle(triangle) {}

  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    const Vec3 ab = b - a, ac = c - a, p = cross(ray.direction, ac);
    const float determinant = dot(ab, p);
    if (determinant == 0) return;
    const Vec3 s = ray.origin - a, q = cross(s, ab);
    const float u = dot(s, p) / determinant, v = dot(ray.direction, q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1) sink.report({dot(ac, q) / determinant, u, v, 0});
  }
};

TEST(Leaks, TheUsualTriangleTestFailsOnTheSameRays) {
  Count total;
  trace_everything<UsualTriangle>(210'000, total, false);
  EXPECT_GT(total.leaks, 0u);
  EXPECT_GT(total.miscounted, total.rays / 1000);
  RecordProperty("leaks", std::to_string(total.leaks));
  RecordProperty("miscounted", std::to_string(total.miscounted));
}

// An instance takes the ray into its own space once, for all of its triangles, so a transform opens no gap.
TEST(Leaks, NoneThroughTransforms) {
  const Body& body = bodies()[0];
  const std::vector<Triangle> triangles = test::triangles(body.mesh);
  const Group<Triangle> group(build(boxes(triangles)), triangles);
  Affine3 shear;
  shear.y.x = 0.7f;
  for (const Affine3& linear : {Affine3::rotation({1, 2, 3}, 33), Affine3::scale({3, 0.2f, 1}),
                                Affine3::scale({1, -1, 1}), Affine3::rotation({3, 1, 2}, 77) * shear})
    for (const Vec3 offset : kOffsets) {
      const Affine3 world_from_object = Affine3::translation(offset) * linear;
      const std::vector instances{InstanceOf<Group<Triangle>>(group, world_from_object)};
      const Bvh bvh = build(boxes(instances));
      test::Mesh in_world = body.mesh;
      for (Vec3& p : in_world.positions) p = world_from_object.point(p);
      Random random(5);
      std::vector<ShapeHit> hits;
      std::size_t leaks = 0, miscounted = 0;
      for (int i = 0; i < 20000; ++i) {
        const auto [ray, starts_inside, must_hit] = aim(in_world, offset, 0.1f, 4, random);
        all_hits(bvh, instances, ray, hits);
        leaks += must_hit && hits.empty();
        miscounted += hits.size() % 2 != std::size_t(starts_inside);
      }
      EXPECT_EQ(leaks, 0u) << offset.x;
      EXPECT_EQ(miscounted, 0u) << offset.x;
    }
}

}  // namespace
}  // namespace boxwood
