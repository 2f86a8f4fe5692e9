#include "boxwood/io/loop_subdivision.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace boxwood::io {
namespace {

constexpr std::size_t kMostTriangles = std::size_t(1) << 22;

using Edge = std::pair<std::uint32_t, std::uint32_t>;  // the smaller vertex first

Edge edge_of(std::uint32_t a, std::uint32_t b) {
  return a < b ? Edge{a, b} : Edge{b, a};
}

struct EdgeFaces {
  int count = 0;
  std::array<std::uint32_t, 2> opposite{};  // the third corners of the first two triangles
  std::uint32_t middle = 0;                 // the vertex that stands on it after the step
};

/// Who stands around each vertex.
struct Neighbours {
  explicit Neighbours(const TriangleMesh& mesh) : ring(mesh.positions.size()), crease(mesh.positions.size()) {
    for (const auto& t : mesh.indices)
      for (int i = 0; i < 3; ++i) {
        EdgeFaces& faces = edges[edge_of(t[i], t[(i + 1) % 3])];
        if (faces.count < 2) faces.opposite[faces.count] = t[(i + 2) % 3];
        ++faces.count;
      }
    for (const auto& [edge, faces] : edges) {
      ring[edge.first].push_back(edge.second);
      ring[edge.second].push_back(edge.first);
      if (faces.count != 2) {
        crease[edge.first].push_back(edge.second);
        crease[edge.second].push_back(edge.first);
      }
    }
  }
  std::map<Edge, EdgeFaces> edges;
  std::vector<std::vector<std::uint32_t>> ring, crease;
};

/// The old vertex and the sum of some others, each weighed by `weight`; the rest is its own.
Vec3 weigh(const TriangleMesh& mesh, std::uint32_t vertex, const std::vector<std::uint32_t>& others,
           float weight) {
  Vec3 sum = mesh.positions[vertex] * (1 - weight * static_cast<float>(others.size()));
  for (const std::uint32_t other : others) sum += mesh.positions[other] * weight;
  return sum;
}

/// Loop's weight of each of n neighbours of a vertex inside.
float ring_weight(std::size_t n) {
  return n == 3 ? 3 / 16.0f : 3 / (8.0f * static_cast<float>(n));
}

TriangleMesh step(const TriangleMesh& mesh) {
  Neighbours around(mesh);
  TriangleMesh out;
  out.positions.reserve(mesh.positions.size() + around.edges.size());
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    const auto &ring = around.ring[v], &crease = around.crease[v];
    if (crease.size() == 2)
      out.positions.push_back(weigh(mesh, v, crease, 1 / 8.0f));
    else if (!crease.empty() || ring.empty())
      out.positions.push_back(mesh.positions[v]);  // a corner
    else
      out.positions.push_back(weigh(mesh, v, ring, ring_weight(ring.size())));
  }
  for (auto& [edge, faces] : around.edges) {
    const Vec3 a = mesh.positions[edge.first], b = mesh.positions[edge.second];
    faces.middle = static_cast<std::uint32_t>(out.positions.size());
    out.positions.push_back(faces.count == 2 ? (a + b) * 0.375f + (mesh.positions[faces.opposite[0]] +
                                                                   mesh.positions[faces.opposite[1]]) *
                                                                      0.125f
                                             : (a + b) * 0.5f);
  }
  const auto middle = [&](std::uint32_t a, std::uint32_t b) { return around.edges.at(edge_of(a, b)).middle; };
  out.indices.reserve(4 * mesh.indices.size());
  for (const auto& [a, b, c] : mesh.indices) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    out.indices.insert(out.indices.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return out;
}

/// Where endless steps bring each vertex, and normals by the triangles around it.
void push_to_limit(TriangleMesh& mesh) {
  const Neighbours around(mesh);
  std::vector<Vec3> limit(mesh.positions.size());
  for (std::uint32_t v = 0; v < limit.size(); ++v) {
    const auto &ring = around.ring[v], &crease = around.crease[v];
    if (crease.size() == 2)
      limit[v] = weigh(mesh, v, crease, 1 / 5.0f);
    else if (!crease.empty() || ring.empty())
      limit[v] = mesh.positions[v];
    else
      limit[v] =
          weigh(mesh, v, ring, 1 / (static_cast<float>(ring.size()) + 3 / (8 * ring_weight(ring.size()))));
  }
  mesh.positions = std::move(limit);
  mesh.normals.assign(mesh.positions.size(), Vec3{0, 0, 0});
  for (const auto& [a, b, c] : mesh.indices) {
    const Vec3 n = cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    for (const std::uint32_t vertex : {a, b, c}) mesh.normals[vertex] += n;
  }
  for (Vec3& n : mesh.normals) {
    n = normalize(n);
    if (!is_finite(n)) n = {0, 0, 1};
  }
}

}  // namespace

TriangleMesh subdivide(const TriangleMesh& cage, int levels) {
  TriangleMesh mesh{cage.positions, cage.indices, {}, {}};
  for (int level = 0; level < levels && mesh.indices.size() <= kMostTriangles / 4; ++level) mesh = step(mesh);
  push_to_limit(mesh);
  return mesh;
}

}  // namespace boxwood::io
