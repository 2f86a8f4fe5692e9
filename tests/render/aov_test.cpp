// What rays tell without light: color, normal, depth, occlusion and cost, and how they are shown.
#include "boxwood/render/aov.h"

#include <gtest/gtest.h>

#include "boxwood/render/camera.h"
#include "boxwood/render/false_color.h"
#include "boxwood/render/lettering.h"
#include "boxwood/scene/srgb.h"
#include "trace.h"

namespace boxwood::render {
namespace {

/// A wall across the view at z = -5 with a red ball before it; looking along -z from the origin.
Scene wall_and_ball() {
  SceneDesc desc;
  const MaterialId grey = desc.add(material_of_kind(Material::Kind::matte, splat(0.4f)));
  const MaterialId red = desc.add(material_of_kind(Material::Kind::plastic, {0.9f, 0.1f, 0.1f}));
  desc.add(std::vector<Quad>{{{-2, -2, -5}, {2, -2, -5}, {2, 2, -5}, {-2, 2, -5}}}, grey);
  desc.add(std::vector<Sphere>{{{0, 0, -3}, 1}}, red);
  desc.camera = Camera{};
  desc.camera->fov_deg = 60;
  return Scene(std::move(desc));
}

RenderOptions options_for(Mode mode, int samples = 1) {
  RenderOptions options;
  options.mode = mode;
  options.width = 33;
  options.height = 33;
  options.samples = samples;
  options.executor = &serial_executor();
  return options;
}

/// The ray through the middle of a pixel, as one sample a pixel takes it.
Ray middle_ray(const Scene& scene, int x, int y) {
  const Lens lens(choose_camera(scene.description(), 33, 33), 33, 33);
  return lens.ray({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, {});
}

TEST(Aov, CostIsWhatTheTraversalCounts) {
  const Scene scene = wall_and_ball();
  const Image cost = render_picture(scene, options_for(Mode::cost)).image;
  for (int y = 0; y < 33; ++y)
    for (int x = 0; x < 33; ++x) {
      TraversalStatistics statistics;
      (void)scene.closest_hit(middle_ray(scene, x, y), statistics);
      ASSERT_EQ(cost.at(x, y)[0], static_cast<float>(statistics.box_tests));
      ASSERT_EQ(cost.at(x, y)[1], static_cast<float>(statistics.shape_tests));
    }
}

TEST(Aov, DepthIsTheDistanceAndZeroForNothing) {
  const Scene scene = wall_and_ball();
  const Image depth = render_picture(scene, options_for(Mode::depth)).image;
  EXPECT_EQ(depth.channels, 1);
  EXPECT_FLOAT_EQ(*depth.at(16, 16), 2);
  for (int y = 0; y < 33; ++y)
    for (int x = 0; x < 33; ++x) {
      const Hit hit = scene.closest_hit(middle_ray(scene, x, y));
      ASSERT_EQ(*depth.at(x, y), hit ? hit.t : 0.0f);
    }
  // With more samples a pixel of ball and nothing is as far as the ball, never in between.
  const Image smooth = render_picture(scene, options_for(Mode::depth, 16)).image;
  for (const float d : smooth.pixels) EXPECT_TRUE(d == 0 || d >= 1.999f);
}

TEST(Aov, DepthAsGreyIsLighterWhenNearerAndNeverHidesAHit) {
  Image depth(3, 1, 1);
  depth.pixels = {2, 10, 0};
  const Image grey = depth_as_grey(depth);
  EXPECT_FLOAT_EQ(grey.pixels[0], 1);
  EXPECT_GT(srgb_from_linear(grey.pixels[1]), 0.1f);
  EXPECT_LT(grey.pixels[1], 0.1f);
  EXPECT_EQ(grey.pixels[2], 0);
}

TEST(Aov, NormalsPointOutInWorldSpace) {
  const Scene scene = wall_and_ball();
  const Image normal = render_picture(scene, options_for(Mode::normal)).image;
  const float* middle = normal.at(16, 16);
  EXPECT_NEAR(length(Vec3{middle[0], middle[1], middle[2]} - Vec3{0, 0, 1}), 0, 1e-5f);
  EXPECT_GT(normal.at(20, 16)[0], 0.1f);  // right of the middle of the ball: +x
  EXPECT_GT(normal.at(16, 12)[1], 0.1f);  // above: +y
  const Image color = normal_as_color(normal);
  EXPECT_NEAR(srgb_from_linear(color.at(16, 16)[0]), 0.5f, 1e-4f);
  EXPECT_NEAR(srgb_from_linear(color.at(16, 16)[2]), 1, 1e-4f);
}

TEST(Aov, ColorIsThatOfTheShapeWithoutLight) {
  const Scene scene = wall_and_ball();
  const Image color = render_picture(scene, options_for(Mode::color)).image;
  const auto pixel = [&](int x, int y) {
    return Vec3{color.at(x, y)[0], color.at(x, y)[1], color.at(x, y)[2]};
  };
  EXPECT_EQ(pixel(16, 16), (Vec3{0.9f, 0.1f, 0.1f}));
  EXPECT_EQ(pixel(24, 24), splat(0.4f));
  EXPECT_EQ(pixel(0, 0), Vec3{});
}

/// Red on the left, blue on the right.
Texture red_and_blue() {
  Texture texture;
  texture.width = 2;
  texture.height = 1;
  texture.texels = {{255, 0, 0, 255}, {0, 0, 255, 255}};
  return texture;
}

TEST(Aov, ColorTakesTheTextureOfTheMesh) {
  SceneDesc desc;
  Texture texture = red_and_blue();
  Material material = material_of_kind(Material::Kind::matte, splat(1));
  material.color_texture = desc.add(std::move(texture));
  TriangleMesh mesh{{{-1, -1, -2}, {1, -1, -2}, {1, 1, -2}, {-1, 1, -2}},
                    {{0, 1, 2}, {0, 2, 3}},
                    {},
                    {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  desc.add(std::move(mesh), desc.add(material));
  desc.camera = Camera{};
  const Scene scene(std::move(desc));
  const Image color = render_picture(scene, options_for(Mode::color)).image;
  EXPECT_GT(color.at(6, 16)[0], 0.9f);
  EXPECT_GT(color.at(26, 16)[2], 0.9f);
}

TEST(Aov, ColorTakesTheTextureBySecondCoordinates) {
  SceneDesc desc;
  Texture texture = red_and_blue();
  texture.is_by_second_uvs = true;
  Material material = material_of_kind(Material::Kind::matte, splat(1));
  material.color_texture = desc.add(std::move(texture));
  TriangleMesh mesh{{{-1, -1, -2}, {1, -1, -2}, {1, 1, -2}, {-1, 1, -2}},
                    {{0, 1, 2}, {0, 2, 3}},
                    {},
                    {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  mesh.second_uvs = {{1, 0}, {0, 0}, {0, 1}, {1, 1}};  // the other way round
  desc.add(std::move(mesh), desc.add(material));
  desc.camera = Camera{};
  const Scene scene(std::move(desc));
  const Image color = render_picture(scene, options_for(Mode::color)).image;
  EXPECT_GT(color.at(6, 16)[2], 0.9f);
  EXPECT_GT(color.at(26, 16)[0], 0.9f);
}

TEST(Aov, OcclusionOfTheOpenAndOfTheShutIn) {
  SceneDesc open;
  open.add(std::vector<Quad>{{{-2, -2, -5}, {2, -2, -5}, {2, 2, -5}, {-2, 2, -5}}});
  open.camera = Camera{};
  EXPECT_EQ(*render_picture(Scene(open), options_for(Mode::occlusion, 8)).image.at(16, 16), 1);
  SceneDesc shut = open;
  shut.add(std::vector<Cuboid>{{{-2.01f, -2.01f, -5.01f}, {2.01f, 2.01f, 0.01f}}});
  shut.add(std::vector<Cuboid>{{{-100, -100, -100}, {-99, -99, -99}}});  // far away: a long reach
  EXPECT_EQ(*render_picture(Scene(shut), options_for(Mode::occlusion, 8)).image.at(16, 16), 0);
}

TEST(FalseColor, TheLegendFitsOrIsLeftOut) {
  for (const auto& [width, height] : {std::pair{640, 360}, {300, 200}, {20, 20}, {1, 1}, {1920, 1080}}) {
    Image cost(width, height, 2);
    for (std::size_t i = 0; i < cost.pixels.size(); ++i) cost.pixels[i] = static_cast<float>(i % 100);
    const Image picture = cost_as_color(cost);
    EXPECT_EQ(picture.width, width);
    EXPECT_EQ(picture.channels, 3);
    for (const float value : picture.pixels) ASSERT_TRUE(value >= 0 && value <= 1);
  }
}

TEST(FalseColor, MoreTestsAreLighter) {
  Image cost(4, 1, 2);
  cost.pixels = {0, 0, 10, 10, 50, 0, 0, 100};
  const Image picture = cost_as_color(cost);
  float last = -1;
  for (int x = 0; x < 4; ++x) {
    const float* p = picture.at(x, 0);
    const float lightness = 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
    EXPECT_GT(lightness, last);
    last = lightness;
  }
}

TEST(Lettering, DrawsWhereItIsTold) {
  Image image(20, 10, 3);
  draw_text(image, 1, 1, 1, "1.", {1, 1, 1});
  EXPECT_EQ(image.at(3, 1)[0], 1);  // the top of the 1
  EXPECT_EQ(image.at(1, 1)[0], 0);
  EXPECT_EQ(image.at(8, 7)[0], 1);  // the dot
  // Off the edge is cut off.
  draw_text(image, -3, -3, 2, "888", {1, 1, 1});
  draw_text(image, 18, 8, 2, "888", {1, 1, 1});
}

}  // namespace
}  // namespace boxwood::render
