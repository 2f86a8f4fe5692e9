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
    struct Way {
      Vec3 from, to, absorption;
    };
    const float last = static_cast<float>(veils);
    const std::vector<Way> ways{
        {{0, 0, 0}, {15, 0, 0}, {}},                     // through all veils
        {{0, 0, 0}, {25, 0, 0}, {}},                     // and to the wall behind them
        {{0, 4, 0}, {15, 4, 0}, {}},                     // beside the veils
        {{0, 4, 0}, {25, 4, 0}, {}},                     // the same, to the other wall
        {{0.25f, 0, 0}, {0.75f, 0, 0}, {}},              // ends before the first
        {{0, 4, 0}, {2, 4, 0}, {0.5f, 0.5f, 0}},         // in a medium, beside
        {{last - 0.5f, 0, 0}, {last + 0.5f, 0, 0}, {}},  // through the last veil alone
    };
    RayBlock block;
    for (int i = 0; i < static_cast<int>(ways.size()); ++i)
      block.set(i, {ways[i].from, 0, ways[i].to - ways[i].from, 1});
    Integers may_meet_veil;
    shadows.find_veiled(block, may_meet_veil);
    AwaitedLight light(ways.size());
    for (std::uint32_t i = 0; i < ways.size(); ++i) {
      const Ray ray = block[static_cast<int>(i)];
      if (may_meet_veil[i] != 0 || max_component(ways[i].absorption) > 0)
        light.add_careful(i, splat(1), ray, ways[i].absorption);
      else
        light.add(i, splat(1), ray);
    }
    std::vector<float> arrived(3 * ways.size());
    std::vector<RayCounts> rays(ways.size());
    shadows.deliver(light, arrived, rays);
    std::vector<Vec3> found;
    for (std::size_t i = 0; i < arrived.size(); i += 3)
      found.push_back({arrived[i], arrived[i + 1], arrived[i + 2]});
    const float share = std::ldexp(1.0f, -veils);
    EXPECT_EQ(found[0], splat(share));
    EXPECT_EQ(found[1], splat(0));
    EXPECT_EQ(found[2], splat(1));
    EXPECT_EQ(found[3], splat(0));
    EXPECT_EQ(found[4], splat(1));
    EXPECT_NEAR(found[5].x, std::exp(-1.0f), 1e-6f);
    EXPECT_EQ(found[5].z, 1);
    EXPECT_EQ(found[6], splat(veils == 0 ? 1 : 0.5f));
    // Who cannot meet a veil, and starts in no medium, is asked one question.
    std::uint32_t asked = 0;
    for (const RayCounts& count : rays) asked += count.shadow;
    EXPECT_GE(asked, veils == 0 ? 6u : 2u);
  }
}

}  // namespace
}  // namespace boxwood::render
