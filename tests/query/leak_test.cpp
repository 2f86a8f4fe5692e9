// leak_test.cpp: can a ray slip through a closed mesh?
#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/query/all_hits.h"
#include "boxwood/query/any_hit.h"
#include "boxwood/query/closest_hit.h"
#include "boxwood/query/group.h"
#include "boxwood/query/nearest.h"
#include "boxwood/query/overlap.h"
#include "boxwood/reference/brute_force.h"
#include "boxwood/shape/instance.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

TEST(Meshes, AreClosed) {
  for (const test::Mesh& mesh : {test::icosphere(3), test::torus(20, 10), test::cube(), test::cube(3),
                                 test::sponge(2), test::rough_sphere(4)})
    EXPECT_TRUE(test::is_closed(mesh));
  EXPECT_FALSE(test::is_closed(test::triangle_soup(3)));
  EXPECT_EQ(test::sponge(3).indices.size(), 36096u);
}

TEST(Smoke, Compiles) {
  const auto shapes = test::triangles(test::icosphere(2));
  const Bvh bvh = build(boxes(shapes));
  const Ray ray{{0, 0, -3}, 0, {0.1f, 0.05f, 1}, kInfinity};
  const reference::BruteForce brute(shapes);
  EXPECT_EQ(closest_hit(bvh, shapes, ray), brute.closest_hit(ray));
  EXPECT_TRUE(any_hit(bvh, shapes, ray));
  EXPECT_EQ(all_hits(bvh, shapes, ray).size(), 2u);
  EXPECT_EQ(nearest(bvh, shapes, {1, 2, 3}, 5), brute.nearest({1, 2, 3}, 5));
  EXPECT_EQ(closest_point(bvh, shapes, {1, 2, 3}), brute.closest_point({1, 2, 3}));
  EXPECT_EQ(overlap(bvh, shapes, Box3{{0, 0, 0}, {1, 1, 1}}), brute.overlap(Box3{{0, 0, 0}, {1, 1, 1}}));
  EXPECT_EQ(overlap(bvh, shapes, {1, 1, 1}, 1), brute.overlap({1, 1, 1}, 1));
  const Group<Triangle> group(bvh, shapes);
  const InstanceOf<Group<Triangle>> instance(group, Affine3::translation({1, 0, 0}));
  const std::vector instances{instance};
  const Bvh top = build(boxes(instances));
  const Ray moved{{1, 0, -3}, 0, {0.1f, 0.05f, 1}, kInfinity};
  EXPECT_TRUE(closest_hit(top, instances, moved).is_hit());
}

}  // namespace
}  // namespace boxwood
