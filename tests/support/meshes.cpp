#include "support/meshes.h"

#include <map>
#include <numbers>
#include <utility>

#include "boxwood/core/random.h"

namespace boxwood::test {
namespace {

using Face = std::array<std::uint32_t, 3>;

/// Gives each point of the lattice {0..cells}^3 that is used one vertex, with coordinates from -1 to 1.
class Lattice {
 public:
  Lattice(Mesh& mesh, int cells) : mesh_(mesh), cells_(cells) {}

  /// The face of the unit cell at `cell` that looks along +axis (side 1) or -axis (side 0).
  void face(std::array<int, 3> cell, int axis, int side) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::uint32_t corners[4];
    for (int i = 0; i < 4; ++i) {
      std::array<int, 3> p = cell;
      p[axis] += side;
      p[u] += (i == 1 || i == 2);
      p[v] += (i == 2 || i == 3);
      corners[i] = vertex(p);
    }
    if (side == 0) std::swap(corners[1], corners[3]);
    mesh_.indices.push_back({corners[0], corners[1], corners[2]});
    mesh_.indices.push_back({corners[0], corners[2], corners[3]});
  }

 private:
  std::uint32_t vertex(std::array<int, 3> p) {
    const auto [found, is_new] = numbers_.try_emplace(p, static_cast<std::uint32_t>(mesh_.positions.size()));
    const auto coordinate = [this](int i) { return float(2 * i - cells_) / float(cells_); };
    if (is_new) mesh_.positions.push_back({coordinate(p[0]), coordinate(p[1]), coordinate(p[2])});
    return found->second;
  }

  Mesh& mesh_;
  int cells_;
  std::map<std::array<int, 3>, std::uint32_t> numbers_;
};

/// Whether the cell belongs to the sponge: no digit position, in base 3, has two or more ones.
bool in_sponge(std::array<int, 3> cell, int cells) {
  for (int c : cell)
    if (c < 0 || c >= cells) return false;
  for (; cells > 1; cells /= 3) {
    if ((cell[0] % 3 == 1) + (cell[1] % 3 == 1) + (cell[2] % 3 == 1) >= 2) return false;
    for (int& c : cell) c /= 3;
  }
  return true;
}

/// The boundary of all unit cells for which `is_solid` holds.
template <class IsSolid>
Mesh boundary(int cells, const IsSolid& is_solid) {
  Mesh mesh;
  Lattice lattice(mesh, cells);
  for (int x = 0; x < cells; ++x)
    for (int y = 0; y < cells; ++y)
      for (int z = 0; z < cells; ++z) {
        if (!is_solid({x, y, z})) continue;
        for (int axis = 0; axis < 3; ++axis)
          for (int side = 0; side < 2; ++side) {
            std::array<int, 3> neighbour{x, y, z};
            neighbour[axis] += side ? 1 : -1;
            if (!is_solid(neighbour)) lattice.face({x, y, z}, axis, side);
          }
      }
  return mesh;
}

/// Cuts every triangle in four; `middle` makes the vertex between two others.
template <class Middle>
void subdivide(Mesh& mesh, const Middle& middle) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
  const auto between = [&](std::uint32_t i, std::uint32_t j) {
    const auto [found, is_new] =
        known.try_emplace(std::minmax(i, j), static_cast<std::uint32_t>(mesh.positions.size()));
    if (is_new) {
      const auto [low, high] = std::minmax(i, j);
      mesh.positions.push_back(middle(mesh.positions[low], mesh.positions[high]));
    }
    return found->second;
  };
  std::vector<Face> finer;
  for (const auto& [a, b, c] : mesh.indices) {
    const std::uint32_t ab = between(a, b), bc = between(b, c), ca = between(c, a);
    finer.insert(finer.end(), {Face{a, ab, ca}, Face{b, bc, ab}, Face{c, ca, bc}, Face{ab, bc, ca}});
  }
  mesh.indices = std::move(finer);
}

Mesh icosahedron() {
  const float g = std::numbers::phi_v<float>;
  Mesh mesh;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3& p : mesh.positions) p = normalize(p);
  mesh.indices = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                  {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                  {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

}  // namespace

Mesh icosphere(int levels) {
  Mesh mesh = icosahedron();
  for (int i = 0; i < levels; ++i) subdivide(mesh, [](Vec3 a, Vec3 b) { return normalize(a + b); });
  return mesh;
}

Mesh torus(int around, int across) {
  Mesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
      const double r = 1 + 0.4 * std::cos(b);
      mesh.positions.push_back({float(r * std::cos(a)), float(r * std::sin(a)), float(0.4 * std::sin(b))});
    }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % around) * across + j % across);
  };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      mesh.indices.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.indices.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

Mesh cube(int cells) {
  return boundary(cells, [cells](std::array<int, 3> cell) {
    for (int c : cell)
      if (c < 0 || c >= cells) return false;
    return true;
  });
}

Mesh sponge(int levels) {
  int cells = 1;
  for (int i = 0; i < levels; ++i) cells *= 3;
  return boundary(cells, [cells](std::array<int, 3> cell) { return in_sponge(cell, cells); });
}

Mesh rough_sphere(int levels, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh = icosahedron();
  float amount = 0.3f;
  for (int i = 0; i < levels; ++i, amount *= 0.5f)
    subdivide(mesh, [&](Vec3 a, Vec3 b) { return (a + b) * (0.5f * (1 + random.uniform(-amount, amount))); });
  return mesh;
}

Mesh triangle_soup(int count, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 middle = random.in_box(splat(-1), splat(1));
    const float size = std::pow(10.0f, random.uniform(-4, 0));
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(middle + random.in_box(splat(-1), splat(1)) * size);
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.indices.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

Mesh placed(Mesh mesh, float scale, Vec3 offset) {
  for (Vec3& p : mesh.positions) p = p * scale + offset;
  return mesh;
}

std::vector<Triangle> triangles(const Mesh& mesh) {
  std::vector<Triangle> out;
  out.reserve(mesh.indices.size());
  for (const auto& [a, b, c] : mesh.indices)
    out.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
  return out;
}

bool is_closed(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const auto& face : mesh.indices)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t i = face[k], j = face[(k + 1) % 3];
      if (i < j)
        ++balance[{i, j}];
      else
        --balance[{j, i}];
    }
  for (const auto& [edge, count] : balance)
    if (count != 0) return false;
  return !mesh.indices.empty();
}

}  // namespace boxwood::test
