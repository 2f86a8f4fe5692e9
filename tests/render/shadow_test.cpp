// shadow_test.cpp: how much light gets through few veils, and through more than are told apart?
#include "boxwood/render/shadow.h"

#include <cmath>

#include <gtest/gtest.h>

#include "trace.h"

namespace boxwood::render {
namespace {

/// `veils` squares across the x axis at x = 1, 2, ..., every second one under a transform; behind them, and
/// beside them, a wall.
SceneDesc veiled(int veils) {
  SceneDesc desc;
  Material half = material_of_kind(Material::Kind::matte, splat(0.5f));
  half.opacity = 0.5f;
  const MaterialId veil = desc.add(half);
  const MaterialId wall = desc.add(material_of_kind(Material::Kind::matte, splat(0.5f)));
  const auto square = [&](float x, float y, MaterialId material) {
    return desc.add(Geometry{
        std::vector<Quad>{{{x, y - 1, -1}, {x, y + 1, -1}, {x, y + 1, 1}, {x, y - 1, 1}}}, material, {}, {}});
  };
  for (int i = 0; i < veils; ++i) {
    const bool is_moved = i % 2 == 1;
    const float x = static_cast<float>(i + 1);
    Instance instance;
    instance.geometry = square(is_moved ? 0 : x, 0, veil);
    if (is_moved) instance.world_from_object = Affine3::translation({x, 0, 0});
    desc.add(instance);
  }
  for (const float y : {0.0f, 4.0f}) {
    Instance instance;
    instance.geometry = square(20, y, wall);
    desc.add(instance);
  }
  return desc;
}

TEST(Shadows, FewVeilsAndMany) {
  for (const int veils : {0, 1, 4, 5, 9}) {
    SCOPED_TRACE(testing::Message() << veils << " veils");
    const Scene scene(veiled(veils));
    const Shadows shadows(scene);
    const auto way = [](Vec3 from, Vec3 to, Vec3 absorption = {}) {
      return Shadows::Way{{from, 0, to - from, 1}, absorption};
    };
    const float last = static_cast<float>(veils);
    const std::vector<Shadows::Way> ways{
        way({0, 0, 0}, {15, 0, 0}),                     // through all veils
        way({0, 0, 0}, {25, 0, 0}),                     // and to the wall behind them
        way({0, 4, 0}, {15, 4, 0}),                     // beside the veils
        way({0, 4, 0}, {25, 4, 0}),                     // the same, to the other wall
        way({0.25f, 0, 0}, {0.75f, 0, 0}),              // ends before the first
        way({0, 4, 0}, {2, 4, 0}, {0.5f, 0.5f, 0}),     // in a medium, beside
        way({last - 0.5f, 0, 0}, {last + 0.5f, 0, 0}),  // through the last veil alone
    };
    std::vector<Vec3> found(ways.size());
    RayCounts rays;
    shadows.transmittances(ways, found, rays);
    const float share = std::ldexp(1.0f, -veils);
    EXPECT_EQ(found[0], splat(share));
    EXPECT_EQ(found[1], splat(0));
    EXPECT_EQ(found[2], splat(1));
    EXPECT_EQ(found[3], splat(0));
    EXPECT_EQ(found[4], splat(1));
    EXPECT_NEAR(found[5].x, std::exp(-1.0f), 1e-6f);
    EXPECT_EQ(found[5].z, 1);
    EXPECT_EQ(found[6], splat(veils == 0 ? 1 : 0.5f));
    // Who cannot meet a veil is asked one question; so is everybody where there is none.
    EXPECT_GE(rays.shadow, veils == 0 ? 7u : 3u);
  }
}

}  // namespace
}  // namespace boxwood::render
