// What materials, textures and lights of a pbrt scene become.
#include <cmath>

#include "boxwood/io/image.h"
#include "io/pbrt_scene.h"

namespace boxwood::io {
namespace {

TEST_F(Pbrt, MaterialsOfBothVersionsBecomeOurs) {
  const SceneDesc desc = scene(
      "WorldBegin\n"
      "Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3]\n" +
      kTriangle +
      "Material \"substrate\" \"rgb Kd\" [.3 .2 .1] \"float uroughness\" .04 \"float vroughness\" .04 \"bool "
      "remaproughness\" \"false\"\n" +
      kTriangle + "Material \"coateddiffuse\" \"float roughness\" .25\n" + kTriangle +
      "Material \"metal\" \"rgb eta\" [1 2 3] \"rgb k\" [0 0 4] \"float roughness\" [1]\n" + kTriangle +
      "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\" \"bool "
      "remaproughness\" false \"float roughness\" .3\n" +
      kTriangle + "Material \"glass\" \"float index\" 1.33 \"rgb Kt\" [0 0 0]\n" + kTriangle +
      "Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"\n" + kTriangle +
      "Material \"mirror\" \"rgb Kr\" [.7 .7 .7]\n" + kTriangle +
      "Material \"uber\" \"rgb opacity\" [0 0 0]\n" + kTriangle + "Material \"none\"\n" + kTriangle +
      "Material \"plastic\" \"texture Kd\" \"half\"\n" + kTriangle);
  using Kind = Material::Kind;
  EXPECT_EQ(material(desc, 0).kind, Kind::matte);
  EXPECT_EQ(material(desc, 0).color, (Vec3{.1f, .2f, .3f}));
  EXPECT_EQ(material(desc, 1).kind, Kind::plastic);
  EXPECT_FLOAT_EQ(material(desc, 1).roughness, .04f);
  EXPECT_EQ(material(desc, 2).kind, Kind::plastic);
  EXPECT_FLOAT_EQ(material(desc, 2).roughness, .5f);  // version 4 takes the root
  EXPECT_EQ(material(desc, 3).kind, Kind::metal);
  expect_near(material(desc, 3).metal_eta, {1, 2, 3});
  expect_near(material(desc, 3).metal_k, {.001f, .001f, 4});
  EXPECT_FLOAT_EQ(material(desc, 3).roughness, 1);                            // 1.62142, clamped
  EXPECT_GT(material(desc, 4).metal_k.x, 3 * material(desc, 4).metal_eta.x);  // gold shines in red
  EXPECT_FLOAT_EQ(material(desc, 4).roughness, .3f);
  EXPECT_EQ(material(desc, 5).kind, Kind::glass);
  EXPECT_FLOAT_EQ(material(desc, 5).ior, 1.33f);
  EXPECT_EQ(material(desc, 5).color, (Vec3{0, 0, 0}));
  EXPECT_NEAR(material(desc, 6).ior, 1.517, .001);
  EXPECT_EQ(material(desc, 7).kind, Kind::mirror);
  EXPECT_EQ(material(desc, 7).color, splat(.7f));
  for (const int clear : {8, 9}) {
    EXPECT_EQ(material(desc, clear).kind, Kind::clear);
  }
  EXPECT_EQ(material(desc, 10).kind, Kind::layered);  // a quarter of the gloss, unless given
  ASSERT_EQ(desc.warnings.size(), 1u);                // the texture that nobody defined
  EXPECT_CONTAINS(desc.warnings[0], "no texture of the name \"half\"");
}

TEST_F(Pbrt, RoughnessIsRemappedAsVersion3Does) {
  const auto alpha = [&](const std::string& roughness) {
    return material(scene("WorldBegin Material \"metal\" \"float roughness\" " + roughness + " " + kTriangle))
        .roughness;
  };
  const double x = std::log(0.1);
  EXPECT_NEAR(alpha("0.1"),
              1.62142 + 0.819955 * x + 0.1734 * x * x + 0.0171201 * x * x * x + 0.000640711 * x * x * x * x,
              1e-5);
  EXPECT_LT(alpha("0.01"), alpha("0.1"));
  EXPECT_EQ(alpha("0"), 0);
}

TEST_F(Pbrt, NamedMaterialsAndLightsMeetInOneMaterial) {
  const SceneDesc desc = scene(
      "WorldBegin MakeNamedMaterial \"m\" \"string type\" \"matte\" \"color Kd\" [1 0 0]\n"
      "NamedMaterial \"m\"\n" +
      kTriangle +
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"float scale\" 2 \"bool twosided\" "
      "true\n" +
      kTriangle + "AttributeEnd\n" + kTriangle);
  ASSERT_EQ(desc.materials.size(), 2u);
  EXPECT_EQ(desc.materials[0].name, "m");
  EXPECT_EQ(material(desc, 0).emission, (Vec3{0, 0, 0}));
  EXPECT_EQ(material(desc, 1).emission, (Vec3{2, 4, 6}));
  EXPECT_TRUE(material(desc, 1).emits_from_both_sides);
  EXPECT_EQ(material(desc, 1).color, (Vec3{1, 0, 0}));
  EXPECT_EQ(desc.geometries[0].material, desc.geometries[2].material);
}

TEST_F(Pbrt, LightsWithoutSurfaces) {
  const SceneDesc desc = scene(
      "WorldBegin LightSource \"infinite\" \"rgb L\" [.1 .2 .3] LightSource \"infinite\" \"float scale\" 2\n"
      "Translate 0 0 1 LightSource \"point\" \"rgb I\" [4 5 6] \"point3 from\" [1 0 0]\n"
      "Rotate 90 1 0 0 LightSource \"distant\" \"rgb L\" [1 1 1] \"point from\" [0 0 1] \"point to\" [0 0 "
      "0]\n"
      "LightSource \"distant\" \"blackbody L\" 6500\n" +
      kTriangle);
  ASSERT_TRUE(desc.sky);
  expect_near(desc.sky->zenith, {2.1f, 2.2f, 2.3f});
  EXPECT_EQ(desc.sky->ground, desc.sky->zenith);
  ASSERT_EQ(desc.point_lights.size(), 1u);
  EXPECT_EQ(desc.point_lights[0].position, (Vec3{1, 0, 1}));
  EXPECT_EQ(desc.point_lights[0].intensity, (Vec3{4, 5, 6}));
  ASSERT_EQ(desc.distant_lights.size(), 2u);
  expect_near(desc.distant_lights[0].direction, {0, 1, 0});
  expect_near(desc.distant_lights[1].irradiance, {1, 1, 1}, .1f);  // daylight is nearly white
}

TEST_F(Pbrt, TheSensorOfVersion4MakesLightBrighter) {
  const std::string lights =
      " WorldBegin LightSource \"point\" LightSource \"spot\" LightSource \"distant\" LightSource "
      "\"infinite\"\n"
      "AreaLightSource \"diffuse\"\n" +
      kTriangle;
  const auto expect_brightness = [&](const std::string& head, float brightness) {
    const SceneDesc desc = scene(head + lights);
    EXPECT_TRUE(desc.warnings.empty());
    EXPECT_FLOAT_EQ(desc.point_lights.at(0).intensity.x, brightness);
    EXPECT_FLOAT_EQ(desc.spot_lights.at(0).intensity.y, brightness);
    EXPECT_FLOAT_EQ(desc.distant_lights.at(0).irradiance.z, brightness);
    EXPECT_FLOAT_EQ(desc.sky->zenith.x, brightness);
    EXPECT_FLOAT_EQ(desc.sky->ground.y, brightness);
    EXPECT_FLOAT_EQ(material(desc).emission.z, brightness);
  };
  expect_brightness("", 1);
  expect_brightness("Film \"rgb\"", 1);
  expect_brightness("Film \"rgb\" \"float iso\" 400", 4);
  expect_brightness("Camera \"perspective\" \"float shutterclose\" .5 Film \"gbuffer\" \"float iso\" 400", 2);
  expect_brightness("Camera \"perspective\" \"float shutterclose\" .5 Film \"image\"", 1);
  expect_error("Film \"rgb\" \"float iso\" 0", 1, "\"iso\" is 0");
}

TEST_F(Pbrt, LightsMaySayHowMuchThereIsInAll) {
  const SceneDesc desc = scene(
      "WorldBegin LightSource \"point\" \"float power\" 100 \"rgb I\" [1 .5 0]\n"
      "LightSource \"spot\" \"float power\" 100 \"float coneangle\" 60 \"float conedeltaangle\" 0\n"
      "LightSource \"distant\" \"float illuminance\" 7\n"
      "LightSource \"infinite\" \"float illuminance\" 6.2831853\n" +
      kTriangle);
  EXPECT_TRUE(desc.warnings.empty());
  expect_near(desc.point_lights.at(0).intensity, {7.957747f, 3.978874f, 0}, 1e-4f);  // over 4 pi
  expect_near(desc.spot_lights.at(0).intensity, splat(31.830989f), 1e-3f);           // over a quarter of that
  expect_near(desc.distant_lights.at(0).irradiance, splat(7), 1e-5f);
  expect_near(desc.sky->zenith, splat(2), 1e-5f);
}

TEST_F(Pbrt, ColorsComeInManyForms) {
  const auto color = [&](const std::string& parameter) {
    return material(scene("WorldBegin Material \"matte\" " + parameter + " " + kTriangle)).color;
  };
  expect_near(color("\"float Kd\" .25"), splat(.25f));
  expect_near(color("\"spectrum Kd\" [400 .5 700 .5]"), splat(.5f));
  expect_near(color("\"xyz Kd\" [.95047 1 1.08883]"), splat(1), 1e-3f);
  const Vec3 red = color("\"spectrum Kd\" [400 0 590 0 610 1 700 1]");
  EXPECT_GT(red.x, 5 * red.y);
  write("grey.spd", "# wavelength value\n400 .3\n700 .3\n");
  expect_near(color("\"spectrum Kd\" \"grey.spd\""), splat(.3f));
  const Vec3 glow = color("\"blackbody Kd\" 2700");
  EXPECT_GT(glow.x, glow.y);
  EXPECT_GT(glow.y, glow.z);
}

TEST_F(Pbrt, TexturesBecomeTexturesAndConstantsAreFolded) {
  // A TGA of two by one pixels, red and blue (rows from the bottom, blue first).
  const char tga[] = {0, 0, 2, 0, 0,  0, 0, 0, 0,         0,         0, 0,
                      2, 0, 1, 0, 24, 0, 0, 0, char(255), char(255), 0, 0};
  write("two.tga", std::string_view(tga, sizeof tga));
  const SceneDesc desc = scene(
      "WorldBegin Texture \"picture\" \"spectrum\" \"imagemap\" \"string filename\" \"two.tga\"\n"
      "Texture \"dark\" \"spectrum\" \"scale\" \"texture tex1\" \"picture\" \"rgb tex2\" [.5 .5 .5]\n"
      "Texture \"gone\" \"spectrum\" \"imagemap\" \"string filename\" \"gone.png\"\n"
      "Texture \"unused\" \"spectrum\" \"imagemap\" \"string filename\" \"also-gone.png\"\n"
      "Texture \"rough\" \"float\" \"constant\" \"float value\" .3\n"
      "Texture \"board\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [1 0 0] \"rgb tex2\" [0 0 0]\n"
      "Material \"matte\" \"texture Kd\" \"picture\"\n" +
      kTriangle + "Material \"matte\" \"texture Kd\" \"dark\"\n" + kTriangle +
      "Material \"matte\" \"texture Kd\" \"gone\"\n" + kTriangle +
      "Material \"metal\" \"texture roughness\" \"rough\" \"bool remaproughness\" \"false\"\n" + kTriangle +
      "Material \"matte\" \"texture Kd\" \"board\"\n" + kTriangle);
  ASSERT_EQ(desc.textures.size(), 2u);
  EXPECT_EQ(desc.textures[0].width, 2);
  ASSERT_TRUE(desc.textures[0].source);
  EXPECT_EQ(desc.textures[0].source->texel(0, 0, 0), (std::array<float, 4>{1, 0, 0, 1}));
  EXPECT_EQ(desc.textures[0].source->texel(0, 1, 0), (std::array<float, 4>{0, 0, 1, 1}));
  EXPECT_EQ(desc.textures[0].source->levels(), 2);
  EXPECT_EQ(material(desc, 0).color_texture, TextureId(0));
  EXPECT_EQ(material(desc, 0).color, splat(1));
  EXPECT_EQ(material(desc, 1).color_texture, TextureId(0));
  EXPECT_EQ(material(desc, 1).color, splat(.5f));
  EXPECT_FALSE(material(desc, 2).color_texture.is_valid());
  EXPECT_EQ(material(desc, 2).color, splat(.18f));
  EXPECT_FLOAT_EQ(material(desc, 3).roughness, .3f);
  EXPECT_EQ(material(desc, 4).color_texture, TextureId(1));
  EXPECT_EQ(desc.textures[1].kind, Texture::Kind::checkerboard);
  EXPECT_EQ(desc.textures[1].first.color, (Vec3{1, 0, 0}));
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], "gone.png");
}

TEST_F(Pbrt, MaterialsOfManyParts) {
  const SceneDesc desc = scene(
      "WorldBegin MakeNamedMaterial \"red\" \"string type\" \"matte\" \"rgb Kd\" [1 0 0]\n"
      "MakeNamedMaterial \"shiny\" \"string type\" \"mirror\"\n"
      "Material \"mix\" \"string namedmaterial1\" \"red\" \"string namedmaterial2\" \"shiny\" \"float "
      "amount\" .3\n" +
      kTriangle + "Material \"mix\" \"string materials\" [\"red\" \"shiny\"] \"float amount\" .3\n" +
      kTriangle +
      "Material \"translucent\" \"rgb Kd\" [.8 .8 .8] \"rgb transmit\" [.25 .25 .25] \"rgb Ks\" [0 0 0]\n" +
      kTriangle + "Material \"diffusetransmission\" \"rgb reflectance\" [.1 .2 .3] \"float scale\" 2\n" +
      kTriangle + "Material \"thindielectric\" \"float eta\" 1.2\n" + kTriangle +
      "Material \"dielectric\" \"float roughness\" .25\n" + kTriangle +
      "Material \"uber\" \"rgb opacity\" [.25 .25 .25]\n" + kTriangle +
      "Material \"coatedconductor\" \"float interface.roughness\" .0625 \"float conductor.roughness\" .25\n" +
      kTriangle + "Material \"disney\" \"float metallic\" .5 \"float roughness\" .4\n" + kTriangle);
  using Kind = Material::Kind;
  for (const int i : {0, 1}) {
    const Material& mix = material(desc, i);
    EXPECT_EQ(mix.kind, Kind::mix);
    // Version 3 gives the share of the first, version 4 that of the second.
    EXPECT_EQ(desc.materials[mix.first.value].name, i == 0 ? "shiny" : "red");
    EXPECT_EQ(desc.materials[mix.second.value].name, i == 0 ? "red" : "shiny");
    EXPECT_FLOAT_EQ(mix.mix_amount, .3f);
  }
  EXPECT_EQ(material(desc, 2).kind, Kind::translucent);
  expect_near(material(desc, 2).color, splat(.4f));
  expect_near(material(desc, 2).transmission_color, splat(.2f));
  expect_near(material(desc, 3).color, {.2f, .4f, .6f});
  expect_near(material(desc, 3).transmission_color, splat(.5f));
  EXPECT_TRUE(material(desc, 4).is_thin);
  EXPECT_FLOAT_EQ(material(desc, 4).ior, 1.2f);
  EXPECT_FLOAT_EQ(material(desc, 5).roughness, .5f);
  EXPECT_EQ(material(desc, 6).kind, Kind::layered);
  EXPECT_FLOAT_EQ(material(desc, 6).opacity, .25f);
  EXPECT_EQ(material(desc, 7).kind, Kind::layered);
  EXPECT_EQ(material(desc, 7).coat, 1);
  EXPECT_FLOAT_EQ(material(desc, 7).coat_roughness, .5f);
  EXPECT_FLOAT_EQ(material(desc, 8).metalness, .5f);
  EXPECT_TRUE(desc.warnings.empty());
}

TEST_F(Pbrt, GlossIsAsStrongAsItsColorSays) {
  const SceneDesc desc = scene("WorldBegin Material \"plastic\" \"rgb Ks\" [1 1 1]\n" + kTriangle +
                               "Material \"plastic\" \"rgb Ks\" [.1 .2 .4]\n" + kTriangle +
                               "Material \"plastic\" \"rgb Ks\" [0 0 0]\n" + kTriangle +
                               "Material \"substrate\" \"rgb Ks\" [.04 .04 .04]\n" + kTriangle +
                               "Material \"substrate\" \"rgb Ks\" [0 0 0]\n" + kTriangle +
                               "Material \"uber\" \"rgb Ks\" [.5 .5 .5]\n" + kTriangle +
                               "Material \"substrate\" \"rgb Ks\" [.02 .04 .06]\n" + kTriangle);
  using Kind = Material::Kind;
  EXPECT_EQ(material(desc, 0).kind, Kind::plastic);
  EXPECT_EQ(material(desc, 1).kind, Kind::layered);
  EXPECT_FLOAT_EQ(material(desc, 1).specular, .4f);
  expect_near(material(desc, 1).specular_color, {.25f, .5f, 1});
  EXPECT_EQ(material(desc, 2).kind, Kind::matte);
  // Of an index of 1.5 a boundary reflects 4% head-on.
  EXPECT_EQ(material(desc, 3).kind, Kind::plastic);
  EXPECT_FLOAT_EQ(material(desc, 3).ior, 1.5f);
  EXPECT_EQ(material(desc, 4).kind, Kind::matte);
  EXPECT_EQ(material(desc, 5).kind, Kind::layered);
  EXPECT_FLOAT_EQ(material(desc, 5).specular, .5f);
  EXPECT_FLOAT_EQ(material(desc, 6).ior, 1.5f);
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], "another color than grey");
}

TEST_F(Pbrt, GlossMayComeFromAPicture) {
  const std::string board =
      "WorldBegin Texture \"board\" \"color\" \"checkerboard\" \"color tex1\" [.5 .5 .5]\n"
      "Texture \"less\" \"color\" \"scale\" \"texture tex1\" \"board\" \"color tex2\" [.5 .5 .5]\n";
  const SceneDesc desc = scene(board + "Material \"plastic\" \"texture Ks\" \"board\"\n" + kTriangle +
                               "Material \"uber\" \"texture Ks\" \"less\"\n" + kTriangle);
  EXPECT_TRUE(desc.warnings.empty());
  for (const int i : {0, 1}) {
    EXPECT_EQ(material(desc, i).kind, Material::Kind::layered);
    EXPECT_TRUE(material(desc, i).specular_texture.texture.is_valid());
  }
  EXPECT_FLOAT_EQ(material(desc, 0).specular, 1);
  EXPECT_FLOAT_EQ(material(desc, 1).specular, .5f);

  // What a substrate reflects head-on makes its index, which is one for the whole surface.
  const SceneDesc coated = scene(board + "Material \"substrate\" \"texture Ks\" \"board\"\n" + kTriangle);
  EXPECT_FLOAT_EQ(material(coated, 0).ior, 1.5f);
  ASSERT_EQ(coated.warnings.size(), 1u);
  EXPECT_CONTAINS(coated.warnings[0], ":3: a picture for the gloss");
}

TEST_F(Pbrt, APatternThatIsNotSupportedIsItsMeanColorAndOneWarning) {
  const SceneDesc desc = scene(
      "WorldBegin Texture \"d\" \"color\" \"dots\" \"rgb inside\" [1 0 0] \"rgb outside\" [0 .5 0]\n"
      "Material \"matte\" \"texture Kd\" \"d\"\n" +
      kTriangle);
  EXPECT_EQ(material(desc).color, (Vec3{.5f, .25f, 0}));
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], ":1: the pattern of a \"dots\" texture");
}

TEST_F(Pbrt, WhatWouldLookOtherwiseIsNamed) {
  const SceneDesc desc = scene(
      "MakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0] \"rgb Le\" [1 1 1]\n"
      "WorldBegin Material \"disney\" \"float sheentint\" .5\n" +
      kTriangle + "Material \"coatedconductor\" \"float interface.eta\" 2\n" + kTriangle);
  ASSERT_EQ(desc.warnings.size(), 3u);
  EXPECT_CONTAINS(desc.warnings[0], "media that shine are not supported");
  EXPECT_CONTAINS(desc.warnings[1], "sheentint");
  EXPECT_CONTAINS(desc.warnings[2], "interface.eta");
}

TEST_F(Pbrt, MediaAlphaAndNormalMapsBelongToTheMaterial) {
  const SceneDesc desc = scene(
      "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [0 0 "
      "0] "
      "\"float scale\" 2\n"
      "WorldBegin Texture \"holes\" \"float\" \"checkerboard\"\n"
      "AttributeBegin MediumInterface \"ink\" \"\" Material \"glass\"\n" +
      kTriangle + "AttributeEnd\nMaterial \"glass\"\n" + kTriangle +
      "Shape \"sphere\" \"texture alpha\" \"holes\"\nShape \"sphere\" \"float alpha\" .5\n"
      "MediumInterface \"nothing\" \"\"\n");
  EXPECT_EQ(material(desc, 0).absorption, (Vec3{2, 4, 6}));
  EXPECT_EQ(material(desc, 0).outer_absorption, (Vec3{0, 0, 0}));
  EXPECT_EQ(material(desc, 1).absorption, (Vec3{0, 0, 0}));
  EXPECT_TRUE(material(desc, 2).opacity_texture.texture.is_valid());
  EXPECT_FLOAT_EQ(material(desc, 3).opacity, .5f);
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], ":10: there is no medium of the name \"nothing\"");
}

TEST_F(Pbrt, BumpsComeByTheNamesOfBothVersions) {
  const SceneDesc desc = scene(
      "WorldBegin Texture \"board\" \"float\" \"checkerboard\"\n"
      "Texture \"high\" \"float\" \"scale\" \"texture tex1\" \"board\" \"float tex2\" .25\n"
      "Material \"matte\" \"texture bumpmap\" \"high\"\n" +
      kTriangle + "Material \"coateddiffuse\" \"texture displacement\" \"board\"\n" + kTriangle +
      "Material \"matte\"\n" + kTriangle +
      "Shape \"sphere\" Material \"matte\" \"texture bumpmap\" \"high\" Shape \"sphere\" Shape \"disk\"\n");
  EXPECT_TRUE(desc.warnings.empty());
  EXPECT_TRUE(std::holds_alternative<std::vector<Sphere>>(desc.geometries.at(3).shapes));
  for (const std::size_t i : {4, 5})  // only meshes have the directions along which bumps lie
    EXPECT_FALSE(mesh(desc, i).uvs.empty());
  EXPECT_FLOAT_EQ(material(desc, 0).bump, .25f);
  EXPECT_TRUE(material(desc, 0).bump_texture.texture.is_valid());
  EXPECT_FLOAT_EQ(material(desc, 1).bump, 1);
  EXPECT_EQ(material(desc, 0).bump_texture.texture, material(desc, 1).bump_texture.texture);
  EXPECT_FALSE(material(desc, 2).bump_texture.texture.is_valid());
}

TEST_F(Pbrt, SpotLightsAndEnvironmentMaps) {
  Image map(4, 2);
  for (float& value : map.pixels) value = 2;
  map.at(1, 1)[0] = std::nanf("");
  map.at(2, 1)[0] = -1;
  write_image(path("sky.exr"), map);
  Image square(8, 8);
  for (int y = 0; y < 8; ++y)  // the middle of the square is +z, its corners are -z
    for (int x = 0; x < 8; ++x)
      square.at(x, y)[0] = std::abs(2 * x - 7) + std::abs(2 * y - 7) < 8 ? 1.0f : 0.0f;
  write_image(path("square.exr"), square);
  const SceneDesc desc = scene(
      "WorldBegin LightSource \"spot\" \"point from\" [0 0 5] \"point to\" [0 0 0] \"float coneangle\" 60 "
      "\"float conedeltaangle\" 15 \"rgb I\" [2 3 4]\n"
      "LightSource \"infinite\" \"string mapname\" \"sky.exr\" \"rgb scale\" [1 2 3]\n"
      "LightSource \"infinite\" \"string filename\" \"square.exr\"\n"
      "LightSource \"infinite\" \"string filename\" \"gone.exr\"\n" +
      kTriangle);
  ASSERT_EQ(desc.spot_lights.size(), 1u);
  expect_near(desc.spot_lights[0].direction, {0, 0, -1});
  EXPECT_NEAR(desc.spot_lights[0].outer_cosine, .5f, 1e-6f);
  EXPECT_NEAR(desc.spot_lights[0].inner_cosine, std::sqrt(.5f), 1e-6f);
  ASSERT_EQ(desc.environments.size(), 2u);
  EXPECT_EQ(desc.environments[0].scale, (Vec3{1, 2, 3}));
  EXPECT_EQ(desc.environments[0].radiance.at(1, 1)[0], 0);
  // The upper half of the sphere is bright, the lower is not.
  const Image& unfolded = desc.environments[1].radiance;
  EXPECT_EQ(unfolded.width, 2 * unfolded.height);
  for (int x = 0; x < unfolded.width; ++x) {
    EXPECT_EQ(unfolded.at(x, 0)[0], 1);
    EXPECT_EQ(unfolded.at(x, unfolded.height - 1)[0], 0);
  }
  ASSERT_TRUE(desc.sky);  // white, for the one that is gone
  ASSERT_EQ(desc.warnings.size(), 2u);
  EXPECT_CONTAINS(desc.warnings[0], ":2: the environment map \"sky.exr\" has 2 pixels");
  EXPECT_CONTAINS(desc.warnings[1], ":4: the environment map cannot be read");
}

}  // namespace
}  // namespace boxwood::io
