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

MaterialId add_material(SceneDesc& desc, const char* name, Kind kind, Vec3 color, float roughness = 0) {
  Material material;
  material.name = name;
  material.kind = kind;
  material.color = color;
  material.roughness = roughness;
  return desc.add(std::move(material));
}

void add_sphere(SceneDesc& desc, const char* name, float x, float z, float radius, MaterialId material) {
  desc.add(Geometry{std::vector<Sphere>{{{x, radius, z}, radius}}, material, {}, name});
}

/// A square lamp of the given half width, facing `target`.
void add_lamp(SceneDesc& desc, const char* name, Vec3 center, Vec3 target, float half_x, float half_y,
              Vec3 radiance) {
  const Affine3 frame =
      Affine3::look_at(target, center, {0, 1, 0});  // its z axis runs from the lamp to the target
  const Vec3 right = frame.x * half_x, up = frame.y * half_y;
  Material lamp;
  lamp.name = name;
  lamp.color = {0, 0, 0};
  lamp.emission = radiance;
  const Quad quad{center - right - up, center + right - up, center + right + up, center - right + up};
  desc.add(Geometry{std::vector<Quad>{quad}, desc.add(std::move(lamp)), {}, name});
}

/// A floor that bends up into a wall in a quarter of a circle; x is its width, -z the way to the wall.
TriangleMesh backdrop() {
  constexpr float kHalfWidth = 40, kFront = 30, kBendStart = -5, kBendRadius = 7, kTop = 30;
  constexpr int kSteps = 64;
  TriangleMesh mesh;
  const auto add_row = [&mesh](float y, float z, Vec3 normal) {
    for (const float x : {-kHalfWidth, kHalfWidth}) {
      mesh.positions.push_back({x, y, z});
      mesh.normals.push_back(normal);
    }
  };
  add_row(0, kFront, {0, 1, 0});
  for (int step = 0; step <= kSteps; ++step) {
    // The point of the unit circle at a tangent of half the angle: no sine, the same bits everywhere.
    const float t = float(step) / kSteps, sine = 2 * t / (1 + t * t), cosine = (1 - t * t) / (1 + t * t);
    add_row(kBendRadius * (1 - cosine), kBendStart - kBendRadius * sine, {0, cosine, sine});
  }
  add_row(kTop, kBendStart - kBendRadius, {0, 0, 1});
  for (std::uint32_t i = 0; i + 3 < mesh.positions.size(); i += 2) {
    mesh.indices.push_back({i, i + 1, i + 3});
    mesh.indices.push_back({i, i + 3, i + 2});
  }
  return mesh;
}

}  // namespace

SceneDesc make_stilllife() {
  SceneDesc desc;

  // Warm colors against the teal of the pot.
  const MaterialId paper = add_material(desc, "paper", Kind::matte, {0.74f, 0.68f, 0.60f});
  const MaterialId teal = add_material(desc, "teal glaze", Kind::plastic, {0.015f, 0.21f, 0.23f}, 0.03f);
  const MaterialId gold = add_material(desc, "gold", Kind::metal, {1.0f, 0.72f, 0.29f}, 0.06f);
  const MaterialId copper = add_material(desc, "brushed copper", Kind::metal, {0.93f, 0.51f, 0.37f}, 0.28f);
  const MaterialId chrome = add_material(desc, "chrome", Kind::mirror, {0.9f, 0.9f, 0.9f});
  const MaterialId glass = add_material(desc, "glass", Kind::glass, {1, 1, 1});
  const MaterialId amber = add_material(desc, "amber glass", Kind::glass, {1.0f, 0.62f, 0.18f});
  const MaterialId coral = add_material(desc, "coral clay", Kind::matte, {0.80f, 0.16f, 0.09f});
  const MaterialId ivory = add_material(desc, "ivory", Kind::plastic, {0.86f, 0.80f, 0.69f}, 0.08f);
  const MaterialId mustard = add_material(desc, "mustard clay", Kind::matte, {0.80f, 0.46f, 0.05f});
  const MaterialId plum = add_material(desc, "plum glaze", Kind::plastic, {0.22f, 0.03f, 0.12f}, 0.05f);

  desc.add(Geometry{backdrop(), paper, {}, "backdrop"});

  // The pot stands left of the middle, its spout pointing right and a little to the front.
  TriangleMesh teapot = teapot_mesh(32);
  const Affine3 world_from_pot =
      Affine3{{0.92f, 0, 0.39191835f}, {0, 1, 0}, {-0.39191835f, 0, 0.92f}, {-1.9f, 0, -0.6f}};
  for (Vec3& p : teapot.positions) p = world_from_pot.point(p);
  for (Vec3& n : teapot.normals) n = normalize(world_from_pot.vector(n));
  desc.add(Geometry{std::move(teapot), teal, {}, "teapot"});

  desc.add(Geometry{sphere_flake({3.5f, 0.95f, -1.6f}, 0.95f, {0, 1, 0}, 5), gold, {}, "sphere flake"});

  add_sphere(desc, "glass sphere", 2.0f, 2.3f, 0.78f, glass);
  add_sphere(desc, "chrome sphere", -3.9f, 2.2f, 0.6f, chrome);
  add_sphere(desc, "coral sphere", 4.0f, 1.5f, 0.62f, coral);
  add_sphere(desc, "copper sphere", -5.4f, -0.4f, 0.8f, copper);
  add_sphere(desc, "amber sphere", 0.2f, 3.3f, 0.36f, amber);
  add_sphere(desc, "ivory sphere", -2.5f, 3.2f, 0.32f, ivory);
  add_sphere(desc, "mustard sphere", 3.1f, 3.5f, 0.28f, mustard);
  add_sphere(desc, "plum sphere", 1.3f, -2.6f, 0.7f, plum);

  add_lamp(desc, "soft lamp", {-7, 9.5f, 7}, {0, 0.8f, 0}, 2.8f, 2.8f, {15.5f, 14.2f, 12.4f});
  add_lamp(desc, "edge lamp", {9, 5.5f, -1.5f}, {0, 1.2f, 0}, 0.7f, 2.6f, {9, 9.6f, 11});

  Sky sky;
  sky.zenith = {0.22f, 0.27f, 0.36f};
  sky.horizon = {0.34f, 0.36f, 0.40f};
  sky.ground = {0.12f, 0.11f, 0.10f};
  desc.sky = sky;

  Camera camera = look_at_camera({1.0f, 3.9f, 14.5f}, {0.05f, 1.28f, 0}, 26, 960, 540);
  camera.lens_radius = 0.07f;
  camera.focus_distance = 13.2f;
  desc.camera = camera;
  return desc;
}

}  // namespace boxwood::gallery
