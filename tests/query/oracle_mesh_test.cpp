// oracle_mesh_test.cpp: every query on every builder's tree over connected meshes,
// under rays aimed at what is shared.
#include <tuple>

#include "oracle.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

/// Vertices and middles of edges.
std::vector<Vec3> vertices_and_edges(const test::Mesh& mesh) {
  std::vector<Vec3> targets = mesh.positions;
  for (const auto& [a, b, c] : mesh.indices)
    targets.push_back(mesh.positions[a] * 0.5f + mesh.positions[b] * 0.5f);
  return targets;
}

TEST(OracleOfMeshes, EveryMeshSmallBigAndFarAway) {
  for (const auto& [name, mesh] :
       {std::pair{"icosphere", test::icosphere(2)}, std::pair{"torus", test::torus(16, 9)},
        std::pair{"cube", test::cube()}, std::pair{"grid cube", test::cube(4)},
        std::pair{"sponge", test::sponge(1)}, std::pair{"rough", test::rough_sphere(2)},
        std::pair{"soup", test::triangle_soup(200)}})
    for (const auto& [where, scale, offset] :
         {std::tuple{"", 1.0f, Vec3{0, 0, 0}}, std::tuple{", tiny", 1e-30f, Vec3{0, 0, 0}},
          std::tuple{", huge", 1e30f, Vec3{0, 0, 0}},
          std::tuple{", far away", 1.0f, Vec3{1e3f, -1e4f, 1e4f}}}) {
      const test::Mesh moved = test::placed(mesh, scale, offset);
      test::expect_equal_to_brute_force(std::string(name) + where, test::triangles(moved),
                                        vertices_and_edges(moved));
    }
}

// The plane of a large triangle that is seen nearly edge-on may be met far off, before the box or behind it.
// With a t from there a tree would drop or keep the crossing by its boxes.
TEST(OracleOfMeshes, LargeTrianglesEdgeOn) {
  Random random(11);
  std::vector<Triangle> blades;
  for (int i = 0; i < 60; ++i) {
    const Vec3 a = random.in_box(splat(-1), splat(1)), along = random.direction();
    const float width = std::pow(10.0f, random.uniform(-7, -1));
    blades.push_back({a, a + along * random.uniform(1, 100), a + random.direction() * width});
  }
  std::vector<Ray> rays;
  for (const Triangle& blade : blades)
    for (int i = 0; i < 300; ++i) {
      // From a point in the plane to another, both moved off it by a few roundings or not at all.
      const auto in_plane = [&] {
        const float u = random.uniform(-1, 2), v = random.uniform(-1, 2);
        const Vec3 off = blade.normal() * (random.below(2) ? 0.0f : random.uniform(-1e-6f, 1e-6f));
        return blade.a + (blade.b - blade.a) * u + (blade.c - blade.a) * v + off;
      };
      const Vec3 from = in_plane(), to = in_plane();
      rays.push_back({from, 0, to - from, random.below(2) ? kInfinity : random.uniform()});
    }

  const reference::BruteForce brute(blades);
  std::vector<ShapeHit> expected, found;
  std::size_t hit_count = 0, edge_on = 0, disagreements = 0;
  const std::vector<test::NamedTree> trees = test::every_tree(boxes(blades));
  for (const Ray& ray : rays) {
    brute.all_hits(ray, expected);
    hit_count += expected.size();
    for (const ShapeHit& hit : expected)
      edge_on += std::fabs(dot(normalize(ray.direction), blades[hit.prim_id.value].normal())) < 0.01f;
    for (const test::NamedTree& tree : trees) {
      all_hits(tree.bvh, blades, ray, found);
      disagreements += found != expected;
      disagreements +=
          !(closest_hit(tree.bvh, blades, ray) == (expected.empty() ? ShapeHit{} : expected.front()));
      disagreements += any_hit(tree.bvh, blades, ray) == expected.empty();
    }
  }
  EXPECT_EQ(disagreements, 0u);
  EXPECT_GT(hit_count, 1000u);
  EXPECT_GT(edge_on, 200u) << "the rays are too easy";
}

}  // namespace
}  // namespace boxwood
