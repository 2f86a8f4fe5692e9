// city.cpp: N towers, long and thin: boxes whose longest axis is the same for all, so that splits along it
// are bad ones.
//
// Towers stand on a square grid of lots, four by four to a block with streets between. Heights follow a heavy
// tail and grow towards the middle of the town.

#include "boxwood/gallery/makers.h"

namespace boxwood::gallery {

namespace {

constexpr float kStreet = 0.9f;  // extra width after each fourth lot; a lot is 1 wide
constexpr std::uint32_t kLotsPerBlock = 4;

/// Where a lot of the grid begins along one axis.
float lot_start(std::uint64_t lot) {
  return float(lot) + kStreet * float(lot / kLotsPerBlock);
}

std::vector<MaterialId> add_facades(SceneDesc& desc) {
  using enum Material::Kind;
  constexpr Paint kFacades[] = {
      {"limestone", {0.76f, 0.70f, 0.60f}, matte, 0},
      {"concrete", {0.56f, 0.56f, 0.55f}, matte, 0},
      {"brick", {0.48f, 0.20f, 0.13f}, matte, 0},
      {"terracotta", {0.72f, 0.38f, 0.22f}, matte, 0},
      {"whitewash", {0.86f, 0.85f, 0.82f}, matte, 0},
      {"blue glass", {0.06f, 0.14f, 0.24f}, plastic, 0.02f},
      {"green glass", {0.05f, 0.16f, 0.15f}, plastic, 0.02f},
      {"bronze", {0.60f, 0.42f, 0.26f}, metal, 0.25f},
  };
  std::vector<MaterialId> ids;
  for (const Paint& facade : kFacades) ids.push_back(add_paint(desc, facade));
  return ids;
}

}  // namespace

SceneDesc make_city(std::uint64_t towers) {
  SceneDesc desc;
  const std::vector<MaterialId> facades = add_facades(desc);
  Random random(towers, 3);

  std::uint64_t side = 1;
  while (side * side < towers) ++side;
  const float width = lot_start(side - 1) + 1, middle = width / 2;
  const float downtown = 0.3f * min(width, 120);  // radius

  std::vector<Cuboid> cuboids(towers);
  std::vector<MaterialId> materials(towers);
  for (std::uint64_t i = 0; i < towers; ++i) {
    const float x = lot_start(i % side) - middle, z = lot_start(i / side) - middle;

    // A footprint somewhere on the lot,
    // and a height of one to ten times its width, more in the middle of the town.
    const float w = random.uniform(0.45f, 0.92f), d = random.uniform(0.45f, 0.92f);
    const float x0 = x + random.uniform(0, 1 - w), z0 = z + random.uniform(0, 1 - d);
    const float distance_squared = (x * x + z * z) / (downtown * downtown);
    const float tail = min(1 / std::sqrt(1 - random.uniform()), 4.0f);
    const float height =
        (1.2f + 4.5f / (1 + distance_squared * distance_squared)) * tail * random.uniform(0.6f, 1.1f);
    cuboids[i] = {{x0, 0, z0}, {x0 + w, height, z0 + d}};
    materials[i] = facades[random.below(std::uint32_t(facades.size()))];
  }
  desc.add(Geometry{std::move(cuboids), {}, std::move(materials), "towers"});

  const float edge = 4 * width + 400;
  desc.add(std::vector<Quad>{{{-edge, 0, edge}, {edge, 0, edge}, {edge, 0, -edge}, {-edge, 0, -edge}}},
           add_paint(desc, {"asphalt", {0.27f, 0.26f, 0.25f}}));

  // From above a corner of the town, never farther off than a town of 60 lots asks for.
  const float reach = min(width, 75);
  desc.camera = look_at_camera({0.78f * reach, 4 + 0.26f * reach, 1.15f * reach}, {0, 8, 0}, 26, 1280, 720);
  desc.sky = clear_sky({-0.75f, 0.62f, 0.75f});
  desc.sky->ground = desc.sky->horizon * 0.8f;  // haze where the ground ends
  return desc;
}

}  // namespace boxwood::gallery
