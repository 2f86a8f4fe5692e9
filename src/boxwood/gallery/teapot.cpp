// teapot.cpp: how do 34 rows of numbers become a teapot? Newell's table is unfolded by its symmetries, then
// its patches become triangles with shared borders.

#include "boxwood/gallery/teapot.h"

#include <bit>
#include <span>
#include <unordered_map>

#include "boxwood/shape/vec3d.h"

namespace boxwood::gallery {

namespace {

/// One row of a surface of revolution: a circle of four cubic arcs. `reach` says how far the inner control
/// points of an arc stand out sideways: 0.56 radii, but the table rounds it for the knob.
struct Ring {
  float radius, reach, height;
};

/// From inside the rim, over it, down the body and in to the middle of the bottom.
/// Every third ring ends a patch.
constexpr Ring kBody[] = {
    {1.4f, 0.784f, 2.4f},
    {1.3375f, 0.749f, 2.53125f},
    {1.4375f, 0.805f, 2.53125f},
    {1.5f, 0.84f, 2.4f},
    {1.75f, 0.98f, 1.875f},
    {2, 1.12f, 1.35f},
    {2, 1.12f, 0.9f},
    {2, 1.12f, 0.45f},
    {1.5f, 0.84f, 0.225f},
    {1.5f, 0.84f, 0.15f},
    {1.5f, 0.84f, 0.075f},
    {1.425f, 0.798f, 0},
    {0, 0, 0},
};

/// From the top of the knob out to the edge of the lid.
constexpr Ring kLid[] = {
    {0, 0, 3.15f},         {0.8f, 0.45f, 3.15f},  {0, 0, 2.85f},        {0.2f, 0.112f, 2.7f},
    {0.4f, 0.224f, 2.55f}, {1.3f, 0.728f, 2.55f}, {1.3f, 0.728f, 2.4f},
};

/// One row of a tube that is its own mirror image in the plane z = 0: where its section meets that plane on
/// the side of the body's middle and on the far side, and how far out the two control points between them
/// stand.
struct Section {
  float inner_x, inner_y, outer_x, outer_y, half_width;
};

constexpr Section kHandle[] = {
    {-1.6f, 2.025f, -1.5f, 2.25f, 0.3f}, {-2.3f, 2.025f, -2.5f, 2.25f, 0.3f},
    {-2.7f, 2.025f, -3, 2.25f, 0.3f},    {-2.7f, 1.8f, -3, 1.8f, 0.3f},
    {-2.7f, 1.575f, -3, 1.35f, 0.3f},    {-2.5f, 1.125f, -2.65f, 0.9375f, 0.3f},
    {-2, 0.9f, -1.9f, 0.6f, 0.3f},
};

constexpr Section kSpout[] = {
    {1.7f, 1.425f, 1.7f, 0.6f, 0.66f},       {2.6f, 1.425f, 3.1f, 0.825f, 0.66f},
    {2.3f, 2.1f, 2.4f, 2.025f, 0.25f},       {2.7f, 2.4f, 3.3f, 2.4f, 0.25f},
    {2.8f, 2.475f, 3.525f, 2.49375f, 0.25f}, {2.9f, 2.475f, 3.45f, 2.5125f, 0.15f},
    {2.8f, 2.4f, 3.2f, 2.4f, 0.15f},
};

/// Body, lid, handle, spout: four patches for three rings, two for three sections.
constexpr std::size_t kPatchesOfPart[] = {16, 8, 4, 4};

template <std::size_t N>
void add_revolution(const Ring (&rings)[N], std::vector<BezierPatch>& patches) {
  constexpr Vec3 kCompass[] = {{1, 0, 0}, {0, 0, -1}, {-1, 0, 0}, {0, 0, 1}};  // counter-clockwise from above
  for (std::size_t first = 0; first + 3 < N; first += 3) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      const Vec3 from = kCompass[quarter], to = kCompass[(quarter + 1) % 4];
      BezierPatch patch;
      for (std::size_t row = 0; row < 4; ++row) {
        const auto [radius, reach, height] = rings[first + row];
        const Vec3 up{0, height, 0};
        patch[row] = {from * radius + up, from * radius + to * reach + up, from * reach + to * radius + up,
                      to * radius + up};
      }
      patches.push_back(patch);
    }
  }
}

template <std::size_t N>
void add_tube(const Section (&sections)[N], std::vector<BezierPatch>& patches) {
  for (std::size_t first = 0; first + 3 < N; first += 3) {
    for (const float side : {1.0f, -1.0f}) {
      BezierPatch patch;
      for (std::size_t row = 0; row < 4; ++row) {
        const Section& s = sections[first + row];
        const float z = side * s.half_width;
        patch[row] = {Vec3{s.outer_x, s.outer_y, 0},
                      {s.outer_x, s.outer_y, z},
                      {s.inner_x, s.inner_y, z},
                      {s.inner_x, s.inner_y, 0}};
        // The mirror image turns the other way round, so that its normal points outward as well.
        if (side < 0) std::swap(patch[row][0], patch[row][3]), std::swap(patch[row][1], patch[row][2]);
      }
      patches.push_back(patch);
    }
  }
}

using detail::Vec3d;

using Weights = std::array<double, 4>;

/// The cubic Bernstein polynomials, and their derivatives.
Weights bernstein(double t) {
  const double s = 1 - t;
  return {s * s * s, 3 * t * s * s, 3 * t * t * s, t * t * t};
}
Weights bernstein_slope(double t) {
  const double s = 1 - t;
  return {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t};
}

Vec3d blend(const BezierPatch& patch, const Weights& along_u, const Weights& along_v) {
  Vec3d sum;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const double w = along_u[i] * along_v[j];
      sum.x += w * patch[i][j].x;
      sum.y += w * patch[i][j].y;
      sum.z += w * patch[i][j].z;
    }
  return sum;
}

Vec3 position_at(const BezierPatch& patch, double u, double v) {
  const Vec3d p = blend(patch, bernstein(u), bernstein(v));
  // -0 becomes +0: equal points, equal bits.
  return {float(p.x) + 0.0f, float(p.y) + 0.0f, float(p.z) + 0.0f};
}

Vec3 normal_at(const BezierPatch& patch, double u, double v) {
  const Vec3d du = blend(patch, bernstein_slope(u), bernstein(v));
  Vec3d dv = blend(patch, bernstein(u), bernstein_slope(v));

  // At a pole a whole row is one point, and d/dv vanishes. Close to it, d/dv is its own slope in u times the
  // way to the pole, so that slope has the direction that d/dv tends to; on the way to u = 1 with the sign
  // turned.
  if (dot(dv, dv) < 1e-18) {
    dv = blend(patch, bernstein_slope(u), bernstein_slope(v));
    if (u > 0.5) dv = dv * -1;
  }

  return narrow(unit(cross(du, dv)));
}

/// Gives each position one vertex, and adds up the normals of the patches that meet there.
class VertexPool {
 public:
  explicit VertexPool(TriangleMesh& mesh) : mesh_(mesh) {}

  std::uint32_t add(Vec3 position, Vec3 normal) {
    const auto [entry, is_new] = index_of_.try_emplace(position, std::uint32_t(mesh_.positions.size()));
    if (is_new) {
      mesh_.positions.push_back(position);
      mesh_.normals.push_back({0, 0, 0});
    }
    mesh_.normals[entry->second] += normal;
    return entry->second;
  }

 private:
  struct Hash {
    std::size_t operator()(Vec3 p) const {
      std::uint64_t h = std::bit_cast<std::uint32_t>(p.x);
      h = (h ^ std::bit_cast<std::uint32_t>(p.y)) * 0x9e3779b97f4a7c15ull;
      h = (h ^ (h >> 32) ^ std::bit_cast<std::uint32_t>(p.z)) * 0x9e3779b97f4a7c15ull;
      return h ^ (h >> 29);
    }
  };

  TriangleMesh& mesh_;
  std::unordered_map<Vec3, std::uint32_t, Hash> index_of_;
};

}  // namespace

std::vector<BezierPatch> teapot_patches() {
  std::vector<BezierPatch> patches;
  add_revolution(kBody, patches);
  add_revolution(kLid, patches);
  add_tube(kHandle, patches);
  add_tube(kSpout, patches);
  return patches;
}

TriangleMesh teapot_mesh(int segments) {
  TriangleMesh mesh;
  const auto side = static_cast<std::size_t>(segments) + 1;
  std::vector<std::uint32_t> grid(side * side);

  const std::vector<BezierPatch> patches = teapot_patches();
  std::size_t first = 0;
  for (const std::size_t count : kPatchesOfPart) {
    // Each part has vertices of its own: the handle touches the belly in a point, with another normal.
    VertexPool pool(mesh);
    for (const BezierPatch& patch : std::span(patches).subspan(first, count)) {
      // On a border one weight is 1 and three are 0,
      // so neighbours compute the same bits and the pool finds them equal.
      for (std::size_t i = 0; i < side; ++i)
        for (std::size_t j = 0; j < side; ++j) {
          const double u = double(i) / segments, v = double(j) / segments;
          grid[i * side + j] = pool.add(position_at(patch, u, v), normal_at(patch, u, v));
        }

      // Two triangles a cell; at a pole one of them has no area and is left out.
      const auto add_triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a != b && b != c && c != a) mesh.indices.push_back({a, b, c});
      };
      for (std::size_t i = 0; i + 1 < side; ++i)
        for (std::size_t j = 0; j + 1 < side; ++j) {
          const std::size_t corner = i * side + j;
          add_triangle(grid[corner], grid[corner + side], grid[corner + side + 1]);
          add_triangle(grid[corner], grid[corner + side + 1], grid[corner + 1]);
        }
    }
    first += count;
  }

  for (Vec3& normal : mesh.normals) normal = normalize(normal);
  return mesh;
}

}  // namespace boxwood::gallery
