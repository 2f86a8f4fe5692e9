// stilllife.cpp: what does `boxwood render` show when nobody names a scene?
//
// A table top before a backdrop that curves up without an edge, as in a photographer's studio: the Utah
// teapot in teal glaze, a golden sphere flake as its counterweight, and spheres of glass, metal and clay
// between them. One large soft lamp from the left makes the shadows, a narrow one from the right draws the
// edges, and a dim sky fills in.

#include "boxwood/gallery/makers.h"
#include "boxwood/gallery/sphere_flake.h"
#include "boxwood/gallery/teapot.h"

namespace boxwood::gallery {

namespace {

using Kind = Material::Kind;

void add_sphere(SceneDesc& desc, const char* name, float x, float z, float radius, MaterialId material) {
  desc.add(Geometry{std::vector<Sphere>{{{x, radius, z}, radius}}, material, {}, name});
}

/// A square lamp of the given half width, facing `target`.
void add_lamp(SceneDesc& desc, const char* name, Vec3 center, Vec3 target, float half_x, float half_y,
              Vec3 radiance) {
  // Its z axis runs from the lamp to the target.
  const Affine3 frame = Affine3::look_at(target, center, {0, 1, 0});
  const Vec3 right = frame.x * half_x, up = frame.y * half_y;
  Material lamp;
  lamp.name = name;
  lamp.color = {0, 0, 0};
  lamp.emission = radiance;
  const Quad quad{center - right - up, center + right - up, center + right + up, center - right + up};
  desc.add(Geometry{std::vector<Quad>{quad}, desc.add(std::move(lamp)), {}, name});
}

/// A floor that bends up into a wall in a quarter of a circle; x is its width, -z the way to the wall. A grid
/// of well-shaped triangles rather than long strips, because the error bounds of a hit grow with how thin its
/// triangle is.
TriangleMesh backdrop() {
  constexpr float kHalfWidth = 32, kFront = 28, kBendStart = -3, kBendRadius = 9, kTop = 25;
  constexpr std::uint32_t kColumns = 128, kBendRows = 64, kFlatRows = 32;
  TriangleMesh mesh;
  std::uint32_t rows = 0;
  const auto add_row = [&](float y, float z, Vec3 normal) {
    for (std::uint32_t column = 0; column <= kColumns; ++column) {
      mesh.positions.push_back({kHalfWidth * (2 * float(column) / kColumns - 1), y, z});
      mesh.normals.push_back(normal);
    }
    ++rows;
  };

  // The floor, the bend and the wall, front to back and upwards.
  for (std::uint32_t row = 0; row < kFlatRows; ++row)
    add_row(0, kFront + (kBendStart - kFront) * float(row) / kFlatRows, {0, 1, 0});
  for (std::uint32_t row = 0; row <= kBendRows; ++row) {
    // A point of the unit circle from the tangent of half its angle: no sine, so the same bits everywhere.
    const float t = float(row) / kBendRows, sine = 2 * t / (1 + t * t), cosine = (1 - t * t) / (1 + t * t);
    add_row(kBendRadius * (1 - cosine), kBendStart - kBendRadius * sine, {0, cosine, sine});
  }
  for (std::uint32_t row = 1; row <= kFlatRows; ++row)
    add_row(kBendRadius + (kTop - kBendRadius) * float(row) / kFlatRows, kBendStart - kBendRadius, {0, 0, 1});

  constexpr std::uint32_t kStride = kColumns + 1;
  for (std::uint32_t row = 0; row + 1 < rows; ++row)
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const std::uint32_t corner = row * kStride + column;
      mesh.indices.push_back({corner, corner + 1, corner + kStride + 1});
      mesh.indices.push_back({corner, corner + kStride + 1, corner + kStride});
    }
  return mesh;
}

}  // namespace

SceneDesc make_stilllife() {
  SceneDesc desc;

  // Warm colors against the teal of the pot.
  const MaterialId paper = add_paint(desc, {"paper", {0.70f, 0.57f, 0.45f}});
  const MaterialId teal = add_paint(desc, {"teal glaze", {0.018f, 0.26f, 0.27f}, Kind::plastic, 0.04f});
  const MaterialId gold = add_paint(desc, {"gold", {1.0f, 0.72f, 0.29f}, Kind::metal, 0.16f});
  const MaterialId copper = add_paint(desc, {"brushed copper", {0.93f, 0.51f, 0.37f}, Kind::metal, 0.28f});
  const MaterialId chrome = add_paint(desc, {"chrome", {0.9f, 0.9f, 0.9f}, Kind::mirror});
  const MaterialId glass = add_paint(desc, {"glass", {1, 1, 1}, Kind::glass});
  const MaterialId amber = add_paint(desc, {"amber glass", {1.0f, 0.62f, 0.18f}, Kind::glass});
  const MaterialId coral = add_paint(desc, {"coral clay", {0.80f, 0.16f, 0.09f}});
  const MaterialId ivory = add_paint(desc, {"ivory", {0.86f, 0.80f, 0.69f}, Kind::plastic, 0.08f});
  const MaterialId mustard = add_paint(desc, {"mustard clay", {0.80f, 0.46f, 0.05f}});
  const MaterialId plum = add_paint(desc, {"plum glaze", {0.22f, 0.03f, 0.12f}, Kind::plastic, 0.05f});

  desc.add(Geometry{backdrop(), paper, {}, "backdrop"});

  // The pot stands left of the middle, its spout pointing right and a little to the front.
  TriangleMesh teapot = teapot_mesh(32);
  const Affine3 world_from_pot =
      Affine3{{0.92f, 0, 0.39191835f}, {0, 1, 0}, {-0.39191835f, 0, 0.92f}, {-1.9f, 0, -0.6f}};
  for (Vec3& p : teapot.positions) p = world_from_pot.point(p);
  for (Vec3& n : teapot.normals) n = normalize(world_from_pot.vector(n));
  desc.add(Geometry{std::move(teapot), teal, {}, "teapot"});

  // Tilted towards the viewer, so that the bare side below is hidden and the lowest balls rest on the table.
  const Vec3 flake_up = normalize({-0.15f, 0.9f, 0.42f});
  desc.add(Geometry{sphere_flake({3.3f, 1.1f, -1.5f}, 0.9f, flake_up, 5), gold, {}, "sphere flake"});

  add_sphere(desc, "glass sphere", 1.75f, 2.0f, 0.8f, glass);
  add_sphere(desc, "chrome sphere", -4.1f, 2.0f, 0.6f, chrome);
  add_sphere(desc, "coral sphere", 3.9f, 1.7f, 0.6f, coral);
  add_sphere(desc, "copper sphere", -5.2f, -0.9f, 0.95f, copper);
  add_sphere(desc, "amber sphere", 0.15f, 3.2f, 0.36f, amber);
  add_sphere(desc, "ivory sphere", -2.75f, 3.0f, 0.32f, ivory);
  add_sphere(desc, "mustard sphere", 2.9f, 3.3f, 0.27f, mustard);
  add_sphere(desc, "plum sphere", 5.3f, -0.4f, 0.75f, plum);

  add_lamp(desc, "soft lamp", {-8.5f, 8.5f, 5}, {0, 0.8f, 0}, 2.6f, 2.6f, {22.5f, 20.3f, 17.5f});
  add_lamp(desc, "edge lamp", {9, 6, -3}, {0, 1.2f, 0}, 0.8f, 2.4f, {7.5f, 8.2f, 9.6f});

  Sky sky;
  sky.zenith = {0.20f, 0.25f, 0.34f};
  sky.horizon = {0.20f, 0.21f, 0.24f};
  sky.ground = {0.10f, 0.09f, 0.08f};
  desc.sky = sky;

  Camera camera = look_at_camera({1.0f, 5.4f, 14.0f}, {0.1f, 1.12f, 0}, 26.5f, 960, 540);
  camera.lens_radius = 0.07f;
  camera.focus_distance = 13.2f;
  desc.camera = camera;
  return desc;
}

}  // namespace boxwood::gallery
