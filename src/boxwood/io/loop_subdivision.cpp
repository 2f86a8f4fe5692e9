#include "boxwood/io/loop_subdivision.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "boxwood/core/radix_sort.h"

namespace boxwood::io {
namespace {

constexpr std::size_t kMostTriangles = std::size_t(1) << 22;

/// Some vertices beside each vertex, one list behind the other.
class VertexLists {
 public:
  explicit VertexLists(std::size_t vertices) : ends_(vertices + 1) {}

  /// First every pair is counted, then every pair is added, in the same order.
  void count(std::uint32_t a, std::uint32_t b) {
    ++ends_[a + 1];
    ++ends_[b + 1];
  }
  void make_room() {
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    others_.resize(ends_.back());
    begins_ = ends_;
    ends_.assign(begins_.begin(), begins_.end() - 1);
  }
  void add(std::uint32_t a, std::uint32_t b) {
    others_[ends_[a]++] = b;
    others_[ends_[b]++] = a;
  }
  std::span<const std::uint32_t> operator[](std::uint32_t v) const {
    return {others_.data() + begins_[v], others_.data() + ends_[v]};
  }

 private:
  std::vector<std::uint32_t> begins_, ends_, others_;
};

struct Edge {
  std::uint32_t first = 0, second = 0;  // the smaller vertex first
  std::uint32_t triangles = 0;
  std::array<std::uint32_t, 2> opposite{};  // the third corners of the first two triangles
  bool is_crease() const { return triangles != 2; }
};

/// The edges of a mesh, in order, and who stands around each vertex.
struct Neighbours {
  explicit Neighbours(const TriangleMesh& mesh) : ring(mesh.positions.size()), crease(mesh.positions.size()) {
    // Sides of the same edge come to stand beside each other.
    const auto corner = [&](std::size_t side, std::size_t step) {
      return mesh.indices[side / 3][(side + step) % 3];
    };
    edge_of_side.resize(3 * mesh.indices.size());
    std::vector<std::uint32_t> sides(edge_of_side.size());
    std::iota(sides.begin(), sides.end(), 0u);
    std::vector<std::uint64_t> keys(sides.size());
    for (std::size_t side = 0; side < keys.size(); ++side) {
      const auto [low, high] = std::minmax({corner(side, 0), corner(side, 1)});
      keys[side] = std::uint64_t(low) << 32 | high;
    }
    radix_sort(keys, sides, serial_executor());
    edges.reserve(keys.size() / 2);
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (i == 0 || keys[i] != keys[i - 1])
        edges.push_back({static_cast<std::uint32_t>(keys[i] >> 32), static_cast<std::uint32_t>(keys[i])});
      Edge& edge = edges.back();
      if (edge.triangles < 2) edge.opposite[edge.triangles] = corner(sides[i], 2);
      ++edge.triangles;
      edge_of_side[sides[i]] = static_cast<std::uint32_t>(edges.size() - 1);
    }

    for (const Edge& edge : edges) {
      ring.count(edge.first, edge.second);
      if (edge.is_crease()) crease.count(edge.first, edge.second);
    }
    ring.make_room();
    crease.make_room();
    for (const Edge& edge : edges) {
      ring.add(edge.first, edge.second);
      if (edge.is_crease()) crease.add(edge.first, edge.second);
    }
  }
  std::vector<Edge> edges;
  std::vector<std::uint32_t> edge_of_side;  // three sides a triangle: from each corner to the next
  VertexLists ring, crease;
};

/// The old vertex and the sum of some others, each weighed by `weight`; the rest is its own.
Vec3 weigh(const TriangleMesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> others,
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
    const auto ring = around.ring[v], crease = around.crease[v];
    if (crease.size() == 2)
      out.positions.push_back(weigh(mesh, v, crease, 1 / 8.0f));
    else if (!crease.empty() || ring.empty())
      out.positions.push_back(mesh.positions[v]);  // a corner
    else
      out.positions.push_back(weigh(mesh, v, ring, ring_weight(ring.size())));
  }
  // A vertex in the middle of each edge, behind those that there were.
  for (const Edge& edge : around.edges) {
    const Vec3 a = mesh.positions[edge.first], b = mesh.positions[edge.second];
    out.positions.push_back(edge.is_crease() ? (a + b) * 0.5f
                                             : (a + b) * 0.375f + (mesh.positions[edge.opposite[0]] +
                                                                   mesh.positions[edge.opposite[1]]) *
                                                                      0.125f);
  }
  out.indices.reserve(4 * mesh.indices.size());
  for (std::size_t t = 0; t < mesh.indices.size(); ++t) {
    const auto middle = [&](std::size_t side) {
      return static_cast<std::uint32_t>(mesh.positions.size() + around.edge_of_side[3 * t + side]);
    };
    const auto [a, b, c] = mesh.indices[t];
    const std::uint32_t ab = middle(0), bc = middle(1), ca = middle(2);
    out.indices.insert(out.indices.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return out;
}

/// Where endless steps bring each vertex, and normals by the triangles around it.
void push_to_limit(TriangleMesh& mesh) {
  const Neighbours around(mesh);
  std::vector<Vec3> limit(mesh.positions.size());
  for (std::uint32_t v = 0; v < limit.size(); ++v) {
    const auto ring = around.ring[v], crease = around.crease[v];
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
