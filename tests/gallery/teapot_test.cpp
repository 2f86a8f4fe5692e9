// teapot_test.cpp: is the teapot Newell's, closed along its seams, and smooth?

#include "boxwood/gallery/teapot.h"

#include <map>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "boxwood/shape/triangle.h"

namespace boxwood::gallery {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

struct Topology {
  std::set<Edge> edges;                                         // without direction
  std::map<std::uint32_t, std::vector<std::uint32_t>> borders;  // edges used once, by their vertices
  bool is_oriented = true;                                      // no edge is used twice in the same direction
};

Topology topology_of(const TriangleMesh& mesh) {
  Topology result;
  std::map<Edge, int> uses;
  for (const auto& t : mesh.indices)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[std::size_t(k)], b = t[std::size_t((k + 1) % 3)];
      if (++uses[{a, b}] > 1) result.is_oriented = false;
      result.edges.insert(std::minmax(a, b));
    }
  for (const auto& [edge, count] : uses)
    if (!uses.contains({edge.second, edge.first})) {
      result.borders[edge.first].push_back(edge.second);
      result.borders[edge.second].push_back(edge.first);
    }
  return result;
}

/// The closed curves that the border edges form, each as its vertices.
std::vector<std::vector<std::uint32_t>> border_loops(const Topology& topology) {
  std::vector<std::vector<std::uint32_t>> loops;
  std::set<std::uint32_t> seen;
  for (const auto& [start, unused] : topology.borders) {
    if (seen.contains(start)) continue;
    std::vector<std::uint32_t> loop, open{start};
    while (!open.empty()) {
      const std::uint32_t vertex = open.back();
      open.pop_back();
      if (!seen.insert(vertex).second) continue;
      loop.push_back(vertex);
      for (const std::uint32_t next : topology.borders.at(vertex)) open.push_back(next);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

TEST(Teapot, HasThe32PatchesAnd306PointsOfTheTable) {
  const std::vector<BezierPatch> patches = teapot_patches();
  EXPECT_EQ(patches.size(), 32u);
  std::set<std::tuple<float, float, float>> points;
  Box3 bounds;
  for (const BezierPatch& patch : patches)
    for (const auto& row : patch)
      for (const Vec3 p : row) {
        points.insert({p.x + 0.0f, p.y + 0.0f, p.z + 0.0f});
        bounds.extend(p);
      }
  // The table lists 306. It repeats the 12 points around the foot where body and bottom meet, and it moves
  // four points at the pole of the knob 0.002 aside that no patch uses.
  EXPECT_EQ(points.size(), 306u - 12 - 4);
  EXPECT_EQ(bounds.lower, (Vec3{-3, 0, -2}));
  EXPECT_EQ(bounds.upper, (Vec3{3.525f, 3.15f, 2}));

  // Some points at random, with z for up as the table has them: (x, y, z) is (x, z, -y) here.
  const std::tuple<float, float, float> kSome[] = {{0.749f, -1.3375f, 2.53125f}, {-1.12f, 2, 0.45f},
                                                   {-2.65f, -0.3f, 0.9375f},     {3.525f, 0.25f, 2.49375f},
                                                   {0.45f, -0.8f, 3.15f},        {-0.224f, -0.4f, 2.55f},
                                                   {0.798f, -1.425f, 0}};
  for (const auto& [x, y, z] : kSome) EXPECT_TRUE(points.contains({x, z, -y})) << x << ' ' << y << ' ' << z;
}

TEST(Teapot, IsClosedWhereNewellsIs) {
  for (const int segments : {2, 3, 5, 16}) {
    SCOPED_TRACE(segments);
    const TriangleMesh mesh = teapot_mesh(segments);
    const Topology topology = topology_of(mesh);
    EXPECT_TRUE(topology.is_oriented);

    // Open: the rim under the lid, the edge of the lid, both ends of handle and spout. The first two are
    // circles of four patches, the others of two.
    const auto loops = border_loops(topology);
    std::multiset<std::size_t> sizes, expected;
    for (const auto& loop : loops) sizes.insert(loop.size());
    for (const int patches : {4, 4, 2, 2, 2, 2})
      expected.insert(std::size_t(patches) * std::size_t(segments));
    EXPECT_EQ(sizes, expected);
    for (const auto& [vertex, neighbours] : topology.borders) EXPECT_EQ(neighbours.size(), 2u);

    // Body and lid are disks, handle and spout are tubes: 1 + 1 + 0 + 0.
    EXPECT_EQ(std::int64_t(mesh.positions.size()) - std::int64_t(topology.edges.size()) +
                  std::int64_t(mesh.indices.size()),
              2);
  }
}

TEST(Teapot, HasNoFlatOrDoubledTriangles) {
  const TriangleMesh mesh = teapot_mesh(16);
  // Each of the eight patches at a pole lacks one triangle a cell along it.
  EXPECT_EQ(mesh.indices.size(), 2u * 32 * 16 * 16 - 8 * 16);
  std::set<std::array<std::uint32_t, 3>> sorted;
  for (auto t : mesh.indices) {
    EXPECT_GT(length(cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                           mesh.positions[t[2]] - mesh.positions[t[0]])),
              0);
    std::sort(t.begin(), t.end());
    EXPECT_TRUE(sorted.insert(t).second);
  }
}

TEST(Teapot, NormalsAreUnitAndOnTheOutside) {
  const TriangleMesh mesh = teapot_mesh(24);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const Vec3 n : mesh.normals) EXPECT_NEAR(length(n), 1, 1e-5);

  // They agree with the winding of every triangle around them ...
  for (const auto& [a, b, c] : mesh.indices) {
    const Vec3 face = Triangle{mesh.positions[a], mesh.positions[b], mesh.positions[c]}.normal();
    for (const std::uint32_t vertex : {a, b, c}) EXPECT_GT(dot(face, mesh.normals[vertex]), 0.7f);
  }
  // ... and point away from the axis on the belly, up on the knob and down under the bottom.
  int on_belly = 0, poles = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3 p = mesh.positions[i], n = mesh.normals[i];
    const float radius = std::sqrt(p.x * p.x + p.z * p.z);
    if (radius > 1.6f && radius <= 2 && p.y < 1.8f && std::fabs(p.z) > 1) {
      EXPECT_GT(n.x * p.x + n.z * p.z, 0);
      ++on_belly;
    }
    if (radius == 0) {
      EXPECT_NEAR(n.y, p.y > 1 ? 1 : -1, 1e-5);
      ++poles;
    }
  }
  EXPECT_GT(on_belly, 100);
  EXPECT_EQ(poles, 2);
}

TEST(Teapot, NormalsAreThoseOfTheSurface) {
  // A finer mesh has the coarse one's vertices too. Its faces around a vertex tend to the tangent plane.
  const TriangleMesh fine = teapot_mesh(128);
  float worst = 1;
  for (const auto& [a, b, c] : fine.indices) {
    const Vec3 face = Triangle{fine.positions[a], fine.positions[b], fine.positions[c]}.normal();
    const Vec3 n = normalize(fine.normals[a] + fine.normals[b] + fine.normals[c]);
    worst = min(worst, dot(face, n));
  }
  EXPECT_GT(worst, 0.99f);
}

TEST(Teapot, SeamsAreSmooth) {
  // At a crease the faces around a vertex would lean away from its normal however fine the mesh is.
  const TriangleMesh mesh = teapot_mesh(64);
  for (const auto& [a, b, c] : mesh.indices) {
    const Vec3 face = Triangle{mesh.positions[a], mesh.positions[b], mesh.positions[c]}.normal();
    for (const std::uint32_t vertex : {a, b, c}) EXPECT_GT(dot(face, mesh.normals[vertex]), 0.95f);
  }
}

}  // namespace
}  // namespace boxwood::gallery
