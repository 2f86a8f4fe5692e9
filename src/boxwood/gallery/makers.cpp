// makers.cpp: what do several scenes share? A camera, paints, a sky and two pieces of arithmetic.

#include "boxwood/gallery/makers.h"

namespace boxwood::gallery {

Camera look_at_camera(Vec3 eye, Vec3 target, float fov_deg, int width, int height) {
  Camera camera;
  camera.world_from_camera = Affine3::look_at(eye, target, {0, 1, 0});
  camera.fov_deg = fov_deg;
  camera.focus_distance = length(target - eye);
  camera.width = width;
  camera.height = height;
  return camera;
}

double cube_root(double x) {
  // Newton's iteration for r^3 = x falls from the start above the root until rounding stops it.
  double root = x;
  for (;;) {
    const double next = root - (root - x / (root * root)) / 3;
    if (!(next < root)) return root;
    root = next;
  }
}

Vec3 in_unit_ball(Random& random) {
  for (;;) {
    const Vec3 p = random.in_box(splat(-1), splat(1));
    if (length_squared(p) <= 1) return p;
  }
}

MaterialId add_paint(SceneDesc& desc, const Paint& paint) {
  Material material;
  material.name = paint.name;
  material.kind = paint.kind;
  material.color = paint.color;
  material.roughness = paint.roughness;
  return desc.add(std::move(material));
}

std::vector<MaterialId> add_palette(SceneDesc& desc) {
  using enum Material::Kind;
  constexpr Paint kPaints[] = {
      {"coral", {0.86f, 0.23f, 0.16f}, matte, 0},      {"amber", {0.93f, 0.52f, 0.08f}, plastic, 0.1f},
      {"sand", {0.84f, 0.71f, 0.52f}, matte, 0},       {"moss", {0.29f, 0.42f, 0.13f}, matte, 0},
      {"teal", {0.03f, 0.33f, 0.36f}, plastic, 0.05f}, {"dusk", {0.11f, 0.17f, 0.43f}, plastic, 0.1f},
      {"plum", {0.34f, 0.09f, 0.27f}, matte, 0},       {"ivory", {0.88f, 0.85f, 0.78f}, plastic, 0.05f},
  };
  std::vector<MaterialId> ids;
  for (const Paint& paint : kPaints) ids.push_back(add_paint(desc, paint));
  return ids;
}

Sky clear_sky(Vec3 towards_sun) {
  Sky sky;
  sky.zenith = {0.16f, 0.30f, 0.62f};
  sky.horizon = {0.72f, 0.79f, 0.88f};
  sky.ground = {0.20f, 0.18f, 0.16f};
  sky.sun_direction = normalize(towards_sun);
  // Seen under 2 degrees the sun covers 9.6e-4 steradian,
  // so this lights a surface that faces it with about 2.2.
  sky.sun_radiance = {2500, 2300, 2000};
  sky.sun_angle_deg = 2;
  return sky;
}

}  // namespace boxwood::gallery
