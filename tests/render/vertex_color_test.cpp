// Colors of vertices: are they seen, by paths, by shadows and in the layers?
#include <gtest/gtest.h>

#include "boxwood/render/render.h"
#include "trace.h"

namespace boxwood::render {
namespace {

/// A square of side 2 at this height that faces up: red on one side, blue on the other, and clear towards -z.
TriangleMesh colored_square(float y) {
  TriangleMesh mesh{{{-1, y, 1}, {1, y, 1}, {1, y, -1}, {-1, y, -1}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
  mesh.colors = {{1, 0, 0, 1}, {0, 0, 1, 1}, {0, 0, 1, 0}, {1, 0, 0, 0}};
  return mesh;
}

/// White, but for what the vertices say; they may say how much of it there is, too.
MaterialId colored_by_vertices(SceneDesc& desc, bool with_alpha) {
  Texture texture;
  texture.kind = Texture::Kind::vertex_color;
  Material material = material_of_kind(Material::Kind::matte, splat(1));
  material.color_texture = desc.add(texture);
  if (with_alpha) material.opacity_texture = {material.color_texture, NumberTexture::Channel::alpha};
  return desc.add(material);
}

TEST(VertexColor, IsTheColorThatPathsSee) {
  SceneDesc desc;
  desc.add(colored_square(0), colored_by_vertices(desc, false));
  desc.sky = constant_sky(1);
  const Scene scene(std::move(desc));
  for (const float x : {-0.5f, 0.0f, 0.8f}) {
    const Vec3 seen = mean_radiance(scene, Ray{{x, 1, 0.1f}, 0, {0, -1, 0}}, 16);
    EXPECT_NEAR(seen.x, (1 - x) / 2, 1e-3f);
    EXPECT_NEAR(seen.z, (1 + x) / 2, 1e-3f);
    EXPECT_EQ(seen.y, 0);
  }
}

TEST(VertexColor, AlphaLetsLightThrough) {
  // Halfway between clear and opaque, the light of a point above is halved; the camera is below.
  const auto lit = [](bool is_there) {
    return floor_radiance(
        [&](SceneDesc& desc) {
          desc.point_lights.push_back({{0, 2, 0}, splat(1)});
          const MaterialId veil = colored_by_vertices(desc, true);
          desc.materials[veil.value].color_texture = {};
          desc.materials[veil.value].color = {0, 0, 0};
          if (is_there) desc.add(colored_square(1), veil);
        },
        4096);
  };
  EXPECT_NEAR(lit(true) / lit(false), 0.5f, 0.02f);
}

TEST(VertexColor, IsInThePictureOfColorsAndInTheLayer) {
  SceneDesc desc;
  const MaterialId material = colored_by_vertices(desc, true);
  desc.add(colored_square(-2), material);
  Camera camera;  // looks down
  camera.world_from_camera = Affine3::look_at({0, 0, 0}, {0, -1, 0}, {0, 0, -1});
  desc.camera = camera;
  const Scene scene(std::move(desc));
  RenderOptions options;
  options.width = options.height = 16;
  options.samples = 1;
  options.mode = Mode::color;
  const Image color = render_picture(scene, options).image;
  EXPECT_GT(color.at(4, 10)[0], color.at(4, 10)[2] + 0.3f);
  EXPECT_GT(color.at(11, 10)[2], color.at(11, 10)[0] + 0.3f);

  // Towards -z, up in the picture, less than half is left: what lies behind is seen, which is nothing.
  options.mode = Mode::path;
  options.layers = {Layer::albedo};
  const Image layers = render_picture(scene, options).image;
  EXPECT_GT(layers.at(4, 10)[3], 0.3f);
  EXPECT_EQ(layers.at(4, 4)[3], 0);
}

}  // namespace
}  // namespace boxwood::render
