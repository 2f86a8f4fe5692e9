// Textures: which texel, mixed how.
#include "boxwood/render/texture.h"

#include <gtest/gtest.h>

#include "boxwood/scene/srgb.h"

namespace boxwood::render {
namespace {

Vec3 texture_color(const Texture& texture, Vec2 uv, float width = 0) {
  SceneDesc desc;
  return texture_at(desc, desc.add(texture), {uv, uv, width, width}).color;
}

Vec3 color_at(const SceneDesc& desc, TextureId id, Vec2 uv) {
  return texture_at(desc, id, {uv, uv}).color;
}

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

TEST(Texture, BeyondTheEdgeItDoesAsItIsTold) {
  Texture texture = four_colors();
  texture.wrap_u = texture.wrap_v = Texture::Wrap::clamp;
  EXPECT_EQ(texture_color(texture, {-3, 9}), (Vec3{1, 0, 0}));
  EXPECT_EQ(texture_color(texture, {7, 9}), (Vec3{0, 1, 0}));
  texture.wrap_u = texture.wrap_v = Texture::Wrap::black;
  EXPECT_EQ(texture_color(texture, {1.5f, 0.75f}), (Vec3{0, 0, 0}));
  EXPECT_EQ(texture_color(texture, {0.75f, 0.75f}), (Vec3{0, 1, 0}));
  texture.wrap_u = texture.wrap_v = Texture::Wrap::mirror;
  EXPECT_EQ(texture_color(texture, {1.25f, 0.75f}), (Vec3{0, 1, 0}));
  EXPECT_EQ(texture_color(texture, {-0.25f, -0.25f}), (Vec3{0, 0, 1}));
  texture.is_inverted = true;
  EXPECT_EQ(texture_color(texture, {0.25f, 0.75f}), (Vec3{0, 1, 1}));
}

TEST(Texture, LiesWhereItsAxesSay) {
  Texture texture = four_colors();
  texture.u_axis = {0, 1};  // a quarter turn
  texture.v_axis = {-1, 0};
  texture.offset = {1, 0};
  EXPECT_EQ(texture_color(texture, {0.25f, 0.25f}), (Vec3{1, 1, 1}));  // at (0.75, 0.25)
}

TEST(Texture, PixelsThatAreNotMixedAreSquares) {
  Texture texture = four_colors();
  texture.is_mixed = false;
  EXPECT_EQ(texture_color(texture, {0.01f, 0.99f}), (Vec3{1, 0, 0}));
  EXPECT_EQ(texture_color(texture, {0.49f, 0.51f}), (Vec3{1, 0, 0}));
  EXPECT_EQ(texture_color(texture, {0.51f, 0.51f}), (Vec3{0, 1, 0}));
  EXPECT_EQ(texture_color(texture, {0.49f, 0.49f}), (Vec3{0, 0, 1}));
  EXPECT_EQ(texture_color(texture, {1.49f, -0.01f}), (Vec3{1, 0, 0}));  // goes on again
  texture.wrap_u = texture.wrap_v = Texture::Wrap::clamp;
  EXPECT_EQ(texture_color(texture, {7, -7}), (Vec3{1, 1, 1}));
  texture.is_mixed = true;
  EXPECT_EQ(texture_color(texture, {0.5f, 0.75f}), (Vec3{0.5f, 0.5f, 0}));
}

TEST(Texture, LiesInTheSetOfCoordinatesThatItAsksFor) {
  SceneDesc desc;
  Texture texture = four_colors();
  const TextureId first = desc.add(texture);
  texture.is_by_second_uvs = true;
  const TextureId second = desc.add(texture);
  const TexturePoint point{{0.25f, 0.75f}, {0.75f, 0.75f}};
  EXPECT_EQ(texture_at(desc, first, point).color, (Vec3{1, 0, 0}));
  EXPECT_EQ(texture_at(desc, second, point).color, (Vec3{0, 1, 0}));

  // In a pattern each part finds its own way.
  Texture product;
  product.kind = Texture::Kind::product;
  product.first.texture = desc.add(four_colors());
  product.second.texture = second;
  EXPECT_EQ(texture_at(desc, desc.add(product), {{0.75f, 0.25f}, {0.75f, 0.75f}}).color, (Vec3{0, 1, 0}));
}

TEST(Texture, ProductsMixesAndCheckerboards) {
  SceneDesc desc;
  const TextureId picture = desc.add(four_colors());
  Texture product;
  product.kind = Texture::Kind::product;
  product.first = {{0.5f, 0.5f, 1}, picture};
  product.second = {{1, 0.5f, 0.25f}, picture};
  const TextureId product_id = desc.add(product);
  EXPECT_EQ(color_at(desc, product_id, {0.75f, 0.25f}), (Vec3{0.5f, 0.25f, 0.25f}));

  Texture mix;
  mix.kind = Texture::Kind::mix;
  mix.first = {{1, 0, 0}, {}};
  mix.second = {{0, 0, 1}, {}};
  mix.amount = {{0.25f, 0.25f, 0.25f}, {}};
  const TextureId mix_id = desc.add(mix);
  EXPECT_EQ(color_at(desc, mix_id, {0, 0}), (Vec3{0.75f, 0, 0.25f}));

  Texture checks;
  checks.kind = Texture::Kind::checkerboard;
  checks.first = {{1, 1, 1}, picture};
  checks.second = {{0, 0, 0}, {}};
  checks.u_axis = {4, 0};
  checks.v_axis = {0, 4};
  const TextureId checks_id = desc.add(checks);
  // The squares are a quarter wide; the picture in them lies as it would alone.
  EXPECT_EQ(color_at(desc, checks_id, {0.2f, 0.2f}), color_at(desc, picture, {0.2f, 0.2f}));
  EXPECT_EQ(color_at(desc, checks_id, {0.3f, 0.2f}), (Vec3{0, 0, 0}));
  EXPECT_EQ(color_at(desc, checks_id, {-0.1f, 0.1f}), (Vec3{0, 0, 0}));
  EXPECT_EQ(color_at(desc, checks_id, {-0.1f, -0.1f}), color_at(desc, picture, {-0.1f, -0.1f}));
}

/// A picture of levels that are each of one grey: 1, 1/2, 1/4.
class Levels final : public PictureSource {
 public:
  int width() const override { return 4; }
  int height() const override { return 4; }
  int levels() const override { return 3; }
  std::array<float, 4> texel(int level, int x, int y) const override {
    EXPECT_TRUE(x >= 0 && y >= 0 && x < (4 >> level) && y < (4 >> level));
    const float grey = 1.0f / static_cast<float>(1 << level);
    return {grey, grey, grey, 1};
  }
};

TEST(Texture, WideLooksTakeCoarseLevels) {
  Texture texture;
  texture.width = texture.height = 4;
  texture.is_srgb = false;
  texture.source = std::make_shared<Levels>();
  EXPECT_EQ(texture_color(texture, {0.3f, 0.3f}, 0).x, 1);
  EXPECT_EQ(texture_color(texture, {0.3f, 0.3f}, 0.25f).x, 1);  // one texel
  EXPECT_EQ(texture_color(texture, {0.3f, 0.3f}, 0.5f).x, 0.5f);
  EXPECT_NEAR(texture_color(texture, {0.3f, 0.3f}, 0.25f * std::sqrt(2.0f)).x, 0.75f, 1e-6f);
  EXPECT_EQ(texture_color(texture, {0.3f, 0.3f}, 100).x, 0.25f);
}

}  // namespace
}  // namespace boxwood::render
