// Textures: which texel, mixed how.
#include "boxwood/render/texture.h"

#include <gtest/gtest.h>

#include "boxwood/scene/srgb.h"

namespace boxwood::render {
namespace {

/// Two by two: red and green above, blue and white below.
Texture four_colors() {
  Texture texture;
  texture.width = texture.height = 2;
  texture.texels = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 255}};
  texture.is_srgb = false;
  return texture;
}

TEST(Texture, VPointsUpAndTexelCentersAreAtHalves) {
  const Texture texture = four_colors();
  EXPECT_EQ(texture_color(texture, {0.25f, 0.75f}), (Vec3{1, 0, 0}));
  EXPECT_EQ(texture_color(texture, {0.75f, 0.75f}), (Vec3{0, 1, 0}));
  EXPECT_EQ(texture_color(texture, {0.25f, 0.25f}), (Vec3{0, 0, 1}));
  EXPECT_EQ(texture_color(texture, {0.75f, 0.25f}), (Vec3{1, 1, 1}));
}

TEST(Texture, MixesNeighboursAndRepeats) {
  const Texture texture = four_colors();
  EXPECT_EQ(texture_color(texture, {0.5f, 0.75f}), (Vec3{0.5f, 0.5f, 0}));
  EXPECT_EQ(texture_color(texture, {0.5f, 0.5f}), (Vec3{0.5f, 0.5f, 0.5f}));
  // At the seam, the neighbour is on the other side.
  EXPECT_EQ(texture_color(texture, {0, 0.75f}), (Vec3{0.5f, 0.5f, 0}));
  EXPECT_EQ(texture_color(texture, {-0.75f, 3.75f}), texture_color(texture, {0.25f, 0.75f}));
}

TEST(Texture, DecodesBeforeMixing) {
  Texture texture = four_colors();
  texture.is_srgb = true;
  texture.texels = {{0, 0, 0, 255}, {255, 188, 255, 255}, {0, 0, 0, 255}, {255, 188, 255, 255}};
  const Vec3 middle = texture_color(texture, {0.5f, 0.5f});
  EXPECT_FLOAT_EQ(middle.x, 0.5f);
  EXPECT_FLOAT_EQ(middle.y, 0.5f * linear_from_srgb(188 / 255.0f));
}

TEST(Texture, AnyCoordinateGivesSomeColor) {
  const Texture texture = four_colors();
  for (const float x : {1e30f, -1e30f, 1e9f, -0.0f, -1e-30f, 0.99999994f, kInfinity, std::nanf("")}) {
    const Vec3 color = texture_color(texture, {x, -x});
    EXPECT_TRUE(is_finite(color) && min_component(color) >= 0 && max_component(color) <= 1) << x;
  }
  EXPECT_EQ(texture_color(Texture{}, {0.5f, 0.5f}), (Vec3{1, 1, 1}));
}

}  // namespace
}  // namespace boxwood::render
