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
#include "support/meshes.h"

namespace boxwood {
namespace {

/// A closed mesh in about [-1, 1]^3, with a ball well inside of it.
struct Body {
  std::string name;
  test::Mesh mesh;
  Vec3 inside;
  float clearance;
};

const std::vector<Body>& bodies() {
  static const std::vector<Body> all{
      {"icosphere, 320", test::icosphere(2), {0, 0, 0}, 0.5f},
      {"icosphere, 20480", test::icosphere(5), {0, 0, 0}, 0.5f},
      {"torus", test::torus(64, 32), {1, 0, 0}, 0.2f},
      {"cube", test::cube(1), {0, 0, 0}, 0.5f},
      {"cube of 12 * 64", test::cube(8), {0, 0, 0}, 0.5f},
      {"sponge", test::sponge(3), {-26.0f / 27, -26.0f / 27, -26.0f / 27}, 0.01f},
      {"rough sphere", test::rough_sphere(5), {0, 0, 0}, 0.2f},
  };
  return all;
}

constexpr Vec3 kOffsets[] = {{0, 0, 0}, {1e3f, -1e3f, 1e3f}, {-1e4f, 1e4f, 1e4f}};

std::size_t ray_budget() {
  const char* wish = std::getenv("BOXWOOD_LONG_TESTS");
  return wish && std::string(wish) == "1" ? 10'000'000 : 1'000'000;
}

/// A ray with what must be true of it.
struct AimedRay {
  Ray ray;
  bool starts_inside, must_hit;
};

/// A vertex, the middle of an edge or a point on it; now and then a point of a face.
Vec3 target(const test::Mesh& mesh, Random& random) {
  const auto& face = mesh.indices[random.below(static_cast<std::uint32_t>(mesh.indices.size()))];
  const Vec3 a = mesh.positions[face[0]], b = mesh.positions[face[1]], c = mesh.positions[face[2]];
  switch (random.below(8)) {
    case 0:
    case 1:
    case 2:
      return a;
    case 3:
    case 4:
      return a * 0.5f + b * 0.5f;
    case 5:
    case 6:
      return a + (b - a) * random.uniform();
    default:
      return a + ((b - a) * random.uniform() + (c - a) * random.uniform()) * 0.5f;
  }
}

AimedRay aim(const test::Mesh& mesh, Vec3 inside, float clearance, float size, Random& random) {
  const Vec3 to = target(mesh, random);
  const Vec3 near_inside = inside + random.in_box(splat(-1), splat(1)) * (clearance * 0.57f);
  switch (random.below(4)) {
    case 0:
    case 1:
      return {{near_inside, 0, to - near_inside, kInfinity}, true, true};
    case 2: {
      // From outside, through the target, to the ball inside.
      const Vec3 from = inside + normalize((to - inside) * (1 / size)) * (size * random.uniform(4, 20));
      return {{from, 0, to - from, kInfinity}, false, true};
    }
    default: {
      // From outside past the target, along an axis or not: the target may be on the silhouette.
      Vec3 way = random.direction();
      if (random.below(2)) {
        way = {0, 0, 0};
        way[static_cast<int>(random.below(3))] = random.below(2) ? 1.0f : -1.0f;
      }
      return {{to - way * (size * 4), 0, way, kInfinity}, false, false};
    }
  }
}

struct Count {
  std::atomic<std::size_t> rays = 0, leaks = 0, miscounted = 0, disagreements = 0, crossings = 0;
};

/// +1 where the ray leaves through the triangle, -1 where it enters:
/// the sign of the area that the crossing test saw.
int crossing_sign(const PreparedRay& ray, const Triangle& triangle) {
  const auto project = [&](Vec3 p) {
    const Vec3 t = p - ray.origin;
    return detail::Point2{t[ray.axis_x] - ray.shear_x * t[ray.axis_z],
                          t[ray.axis_y] - ray.shear_y * t[ray.axis_z]};
  };
  const auto a = project(triangle.a), b = project(triangle.b), c = project(triangle.c);
  const auto edge = [](detail::Point2 p, detail::Point2 q) { return double(p.x) * q.y - double(p.y) * q.x; };
  const double area = edge(a, b) + edge(b, c) + edge(c, a);
  return (area > 0) == (ray.shear_z > 0) ? 1 : -1;
}

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
