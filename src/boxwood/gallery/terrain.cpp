// terrain.cpp: an island of N by N cells: what does a fractal landscape look like?
//
// The height is a sum of octaves of value noise in which an octave counts less where the ones before it are
// steep, as erosion leaves it: fractional Brownian motion after Musgrave (Ebert et al., Texturing and
// Modeling, 2003, chapter 16) damped by the slope. The function does not depend on N; more cells show the
// same island with more octaves.

#include "boxwood/gallery/makers.h"

namespace boxwood::gallery {

namespace {

constexpr float kHalfWidth = 10;  // of the square, in scene units
constexpr float kSeaLevel = 0;
constexpr float kTopHeight = 3.2f;  // the colors end here

/// Noise and its slope.
struct Sample {
  float value, dx, dy;
};

/// A fixed random number in [-1, 1) for each point of the lattice.
float lattice_value(std::int32_t x, std::int32_t y) {
  std::uint32_t h = std::uint32_t(x) * 0x9e3779b1u ^ std::uint32_t(y) * 0x85ebca77u;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return float(std::int32_t(h ^ (h >> 15))) * 0x1p-31f;
}

/// Lattice values blended by a quintic,
/// whose first two derivatives vanish at the lattice, so no creases show.
Sample value_noise(float x, float y) {
  const float fx = std::floor(x), fy = std::floor(y);
  const auto ix = static_cast<std::int32_t>(fx), iy = static_cast<std::int32_t>(fy);
  const float tx = x - fx, ty = y - fy;
  const float bx = tx * tx * tx * (tx * (tx * 6 - 15) + 10), by = ty * ty * ty * (ty * (ty * 6 - 15) + 10);
  const float sx = 30 * tx * tx * (tx * (tx - 2) + 1), sy = 30 * ty * ty * (ty * (ty - 2) + 1);

  const float a = lattice_value(ix, iy), b = lattice_value(ix + 1, iy);
  const float c = lattice_value(ix, iy + 1), d = lattice_value(ix + 1, iy + 1);
  const float twist = a - b - c + d;
  return {a + (b - a) * bx + (c - a) * by + twist * bx * by, sx * (b - a + twist * by),
          sy * (c - a + twist * bx)};
}

/// The height of the ground at a point of [-1, 1] x [-1, 1], before the sea covers what is below it.
float height_at(float x, float y, int octaves) {
  float px = 1.6f * x + 7.3f, py = 1.6f * y + 2.9f;
  float sum = 0, amplitude = 1, slope_x = 0, slope_y = 0;
  for (int octave = 0; octave < octaves; ++octave) {
    const Sample n = value_noise(px, py);
    slope_x += n.dx;
    slope_y += n.dy;
    sum += amplitude * n.value / (1 + 0.6f * (slope_x * slope_x + slope_y * slope_y));
    amplitude *= 0.5f;

    // Twice as fine, and turned by the angle of the triangle 3, 4, 5, so that the lattices do not line up.
    const float turned = 1.6f * px - 1.2f * py;
    py = 1.2f * px + 1.6f * py;
    px = turned;
  }

  // Lift the middle and sink the borders, so that the land ends in the sea.
  const float r = x * x + y * y;
  return 2.1f * sum + 2.0f * (1 - r) * (1 - r) * (r < 1 ? 1.0f : -1.0f) - 0.45f;
}

Vec3 mix(Vec3 a, Vec3 b, float t) {
  return a + (b - a) * t;
}

/// 0 below `from`, 1 above `to`, smooth between.
float ramp(float from, float to, float x) {
  const float t = max(0, min(1, (x - from) / (to - from)));
  return t * t * (3 - 2 * t);
}

/// The color of ground by its steepness (0 flat, 1 upright) and height (0 the shore, 1 the top), in sRGB.
Vec3 ground_color(float steepness, float height) {
  constexpr Vec3 kSand{0.84f, 0.77f, 0.60f}, kGrass{0.42f, 0.55f, 0.25f}, kForest{0.22f, 0.36f, 0.20f},
      kRock{0.46f, 0.42f, 0.39f}, kScree{0.60f, 0.56f, 0.52f}, kSnow{0.95f, 0.96f, 0.98f};
  Vec3 color = mix(kSand, kGrass, ramp(0.02f, 0.06f, height));
  color = mix(color, kForest, ramp(0.08f, 0.30f, height));
  color = mix(color, kScree, ramp(0.34f, 0.52f, height));
  color = mix(color, kRock, ramp(0.12f, 0.30f, steepness) * ramp(0.03f, 0.10f, height));
  return mix(color, kSnow, ramp(0.52f, 0.62f, height) * (1 - ramp(0.22f, 0.38f, steepness)));
}

/// One chart of all the colors: steepness runs to the right, height upwards.
/// Vertices point into it by their uv.
Texture ground_chart() {
  Texture chart;
  chart.name = "ground by steepness and height";
  chart.width = 64;
  chart.height = 256;
  for (int row = 0; row < chart.height; ++row)
    for (int column = 0; column < chart.width; ++column) {
      const float steepness = (float(column) + 0.5f) / float(chart.width);
      const float height = 1 - (float(row) + 0.5f) / float(chart.height);
      const Vec3 c = ground_color(steepness, height) * 255;
      chart.texels.push_back(
          {std::uint8_t(c.x + 0.5f), std::uint8_t(c.y + 0.5f), std::uint8_t(c.z + 0.5f), std::uint8_t(255)});
    }
  return chart;
}

}  // namespace

SceneDesc make_terrain(std::uint64_t cells) {
  const auto n = static_cast<std::size_t>(cells), side = n + 1;

  // As many octaves as the grid can show: the finest waves span two cells.
  int octaves = 1;
  while (octaves < 11 && (std::size_t(4) << octaves) <= n) ++octaves;

  TriangleMesh mesh;
  mesh.positions.resize(side * side);
  const auto vertex = [&](std::size_t i, std::size_t j) -> Vec3& { return mesh.positions[j * side + i]; };
  for (std::size_t j = 0; j < side; ++j)
    for (std::size_t i = 0; i < side; ++i) {
      const float x = float(2 * double(i) / double(n) - 1), z = float(2 * double(j) / double(n) - 1);
      vertex(i, j) = {kHalfWidth * x, max(height_at(x, z, octaves), kSeaLevel), kHalfWidth * z};
    }

  // Normals from the neighbours' heights;
  // from them the steepness, and with the height the place in the chart.
  mesh.normals.resize(side * side);
  mesh.uvs.resize(side * side);
  for (std::size_t j = 0; j < side; ++j)
    for (std::size_t i = 0; i < side; ++i) {
      const Vec3 west = vertex(i > 0 ? i - 1 : i, j), east = vertex(i < n ? i + 1 : i, j);
      const Vec3 north = vertex(i, j > 0 ? j - 1 : j), south = vertex(i, j < n ? j + 1 : j);
      const Vec3 normal = normalize(cross(south - north, east - west));
      mesh.normals[j * side + i] = normal;
      const float height = vertex(i, j).y / kTopHeight;
      mesh.uvs[j * side + i] = {max(0.01f, min(0.99f, 1 - normal.y)), max(0.002f, min(0.998f, height))};
    }

  SceneDesc desc;
  Material ground;
  ground.name = "ground";
  ground.color = {1, 1, 1};
  ground.color_texture = desc.add(ground_chart());
  const MaterialId ground_id = desc.add(std::move(ground));
  Material sea;
  sea.name = "sea";
  sea.kind = Material::Kind::plastic;
  sea.color = {0.015f, 0.075f, 0.11f};
  sea.ior = 1.33f;
  sea.roughness = 0.04f;
  const MaterialId sea_id = desc.add(std::move(sea));

  // Two triangles a cell; sea where all three corners are under water.
  mesh.indices.reserve(2 * n * n);
  std::vector<MaterialId> materials;
  materials.reserve(2 * n * n);
  const auto add_triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
    mesh.indices.push_back({std::uint32_t(a), std::uint32_t(b), std::uint32_t(c)});
    const float highest = max(mesh.positions[a].y, max(mesh.positions[b].y, mesh.positions[c].y));
    materials.push_back(highest > kSeaLevel ? ground_id : sea_id);
  };
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t corner = j * side + i;
      add_triangle(corner, corner + side, corner + side + 1);
      add_triangle(corner, corner + side + 1, corner + 1);
    }
  desc.add(Geometry{std::move(mesh), ground_id, std::move(materials), "terrain"});

  desc.camera = look_at_camera({6.0f, 6.0f, 16.5f}, {-0.35f, 0.25f, 0}, 31.5f, 1280, 720);
  desc.sky = clear_sky({-0.8f, 0.5f, 0.25f});
  desc.sky->ground = {0.085f, 0.12f, 0.165f};  // the sea goes on beyond the square
  return desc;
}

}  // namespace boxwood::gallery
