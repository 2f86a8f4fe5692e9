// What materials, textures, cameras and lights of a glTF file become.
#include <cmath>

#include "boxwood/io/image.h"
#include "io/gltf_source.h"

namespace boxwood::io {
namespace {

TEST_F(Gltf, MaterialsBecomeOurs) {
  Source source;
  source.parts["materials"] = R"([
      {"name":"gold","pbrMetallicRoughness":{"baseColorFactor":[1,0.8,0.3,1],"metallicFactor":1,"roughnessFactor":0.5}},
      {"pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.2},"extensions":{"KHR_materials_ior":{"ior":1.7}}},
      {"pbrMetallicRoughness":{"metallicFactor":0},"emissiveFactor":[1,0.5,0],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4}},"doubleSided":true},
      {"pbrMetallicRoughness":{"metallicFactor":0},"extensions":{"KHR_materials_transmission":{"transmissionFactor":1}}}])";
  source.parts["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0},"material":2}]}])";
  const SceneDesc desc = scene(source);
  ASSERT_EQ(desc.materials.size(), 4u);
  EXPECT_EQ(desc.geometries[0].material, MaterialId(2));
  EXPECT_EQ(desc.materials[0].name, "gold");
  EXPECT_EQ(desc.materials[0].kind, Material::Kind::layered);
  EXPECT_EQ(desc.materials[0].metalness, 1);
  EXPECT_EQ(desc.materials[0].color, (Vec3{1, .8f, .3f}));
  EXPECT_FLOAT_EQ(desc.materials[0].roughness, .5f);
  EXPECT_EQ(desc.materials[0].roughness_scale, Material::RoughnessScale::square_root_of_alpha);
  EXPECT_EQ(desc.materials[1].metalness, 0);
  EXPECT_FLOAT_EQ(desc.materials[1].ior, 1.7f);
  EXPECT_EQ(desc.materials[2].emission, (Vec3{4, 2, 0}));
  EXPECT_TRUE(desc.materials[2].emits_from_both_sides);
  EXPECT_EQ(desc.materials[3].transmission, 1);
  EXPECT_TRUE(desc.materials[3].is_thin);
}

TEST_F(Gltf, OnlyWhatIsBrighterThanWhiteIsALamp) {
  const auto is_lit = [&](const std::string& extensions) {
    Source source;
    source.parts["materials"] = R"([{"emissiveFactor":[1,1,1])" + extensions + "}]";
    source.parts["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0},"material":0}]}])";
    return scene(source).is_lit_by_glow;
  };
  EXPECT_FALSE(is_lit(""));  // a screen
  EXPECT_TRUE(is_lit(R"(,"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":1.5}})"));
}

TEST_F(Gltf, SpecularAndGlossMakePlasticOrMetal) {
  Source source;
  source.parts["extensionsRequired"] = R"(["KHR_materials_pbrSpecularGlossiness"])";
  const auto material = [&](const std::string& gloss, const std::string& own) {
    source.parts["materials"] =
        R"([{"extensions":{"KHR_materials_pbrSpecularGlossiness":{)" + gloss + "}}" + own + "}]";
    source.parts["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0},"material":0}]}])";
    const SceneDesc desc = scene(source);
    EXPECT_TRUE(desc.warnings.empty());
    return desc.materials.at(0);
  };
  Material m = material(
      R"("diffuseFactor":[0.5,0.25,0,1],"specularFactor":[0.04,0.02,0.04],"glossinessFactor":0.75)", "");
  EXPECT_EQ(m.color, (Vec3{0.5f, 0.25f, 0}));
  EXPECT_EQ(m.metalness, 0);
  EXPECT_FLOAT_EQ(m.roughness, 0.25f);
  EXPECT_FLOAT_EQ(m.ior, 1.5f);
  expect_near(m.specular_color, {1, 0.5f, 1});
  m = material(R"("diffuseFactor":[0,0,0,1],"specularFactor":[1,0.8,0.3])", "");
  EXPECT_EQ(m.metalness, 1);
  EXPECT_EQ(m.roughness, 0);
  EXPECT_EQ(m.color, (Vec3{1, 0.8f, 0.3f}));
  m = material(R"("specularFactor":[0,0,0])", "");
  EXPECT_EQ(m.specular, 0);
  // What the file says in the format's own way comes first.
  m = material(R"("diffuseFactor":[0,0,0,1])", R"(,"pbrMetallicRoughness":{"metallicFactor":0.5})");
  EXPECT_EQ(m.metalness, 0.5f);
  EXPECT_EQ(m.color, (Vec3{1, 1, 1}));

  source.parts["materials"] =
      R"([{"extensions":{"KHR_materials_pbrSpecularGlossiness":{"specularGlossinessTexture":{"index":0}}}}])";
  const SceneDesc desc = scene(source);
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], "pictures of gloss");
  EXPECT_EQ(desc.materials.at(0).metalness, 0);
}

TEST_F(Gltf, UnlitMaterialsGlowInTheirColor) {
  Source source;
  source.parts["extensionsRequired"] = R"(["KHR_materials_unlit","KHR_materials_variants"])";
  source.parts["materials"] =
      R"([{"pbrMetallicRoughness":{"baseColorFactor":[0.25,0.5,1,0.5]},"alphaMode":"BLEND","extensions":{"KHR_materials_unlit":{}}}])";
  source.parts["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0},"material":0}]}])";
  const SceneDesc desc = scene(source);
  EXPECT_TRUE(desc.warnings.empty());
  const Material& m = desc.materials.at(0);
  EXPECT_EQ(m.kind, Material::Kind::matte);
  EXPECT_EQ(m.color, (Vec3{0, 0, 0}));
  EXPECT_EQ(m.emission, (Vec3{0.25f, 0.5f, 1}));
  EXPECT_TRUE(m.emits_from_both_sides);
  EXPECT_FLOAT_EQ(m.opacity, 0.5f);
  EXPECT_FALSE(desc.is_lit_by_glow);
}

TEST_F(Gltf, ExtensionsOfMaterials) {
  Source source;
  source.parts["materials"] = R"([{"extensions":{
      "KHR_materials_transmission":{"transmissionFactor":0.9},
      "KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":2,"attenuationColor":[0.25,1,0.5]},
      "KHR_materials_clearcoat":{"clearcoatFactor":0.5,"clearcoatRoughnessFactor":0.3},
      "KHR_materials_sheen":{"sheenColorFactor":[0.1,0.2,0.3],"sheenRoughnessFactor":0.4},
      "KHR_materials_specular":{"specularFactor":0.6,"specularColorFactor":[1,0.5,0.25]}}},
      {"alphaMode":"MASK","alphaCutoff":0.7,"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.9]}},
      {"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.25]}},
      {"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.25]}}])";
  source.parts["extensionsUsed"] =
      R"(["KHR_materials_transmission","KHR_materials_volume","KHR_materials_clearcoat","KHR_materials_sheen","KHR_materials_specular"])";
  const SceneDesc desc = scene(source);
  EXPECT_TRUE(desc.warnings.empty());
  const Material& m = desc.materials[0];
  EXPECT_FLOAT_EQ(m.transmission, .9f);
  EXPECT_FALSE(m.is_thin);
  EXPECT_NEAR(m.absorption.x, std::log(4.0f) / 2, 1e-5f);  // a quarter is left after 2
  EXPECT_EQ(m.absorption.y, 0);
  EXPECT_FLOAT_EQ(m.coat, .5f);
  EXPECT_FLOAT_EQ(m.coat_roughness, .3f);
  EXPECT_EQ(m.sheen_color, (Vec3{.1f, .2f, .3f}));
  EXPECT_FLOAT_EQ(m.sheen_roughness, .4f);
  EXPECT_FLOAT_EQ(m.specular, .6f);
  EXPECT_EQ(m.specular_color, (Vec3{1, .5f, .25f}));
  EXPECT_FLOAT_EQ(desc.materials[1].opacity, .9f);
  EXPECT_FLOAT_EQ(desc.materials[1].alpha_cutoff, .7f);
  EXPECT_FLOAT_EQ(desc.materials[2].opacity, .25f);
  EXPECT_LT(desc.materials[2].alpha_cutoff, 0);
  EXPECT_EQ(desc.materials[3].opacity, 1);
}

TEST_F(Gltf, TexturesOfAllKindsAreReadAsTheyAreMeant) {
  Image picture(1, 1);
  picture.pixels = {0, 1, 0};
  write_image(path("p.png"), picture);
  Source source;
  source.parts["images"] = R"([{"uri":"p.png"}])";
  source.parts["samplers"] = R"([{"wrapS":33071,"wrapT":33648,"magFilter":9728}])";
  source.parts["textures"] = R"([{"source":0},{"source":0,"sampler":0}])";
  source.parts["extensionsUsed"] = R"(["KHR_texture_transform"])";
  source.parts["materials"] = R"([{"alphaMode":"MASK","emissiveFactor":[1,1,1],"emissiveTexture":{"index":0},
      "normalTexture":{"index":0,"scale":0.5},"occlusionTexture":{"index":0},
      "pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":1},"baseColorTexture":{"index":0,
      "extensions":{"KHR_texture_transform":{"offset":[0.5,0.25],"scale":[2,3]}}}}}])";
  const SceneDesc desc = scene(source);
  EXPECT_TRUE(desc.warnings.empty());
  const Material& m = desc.materials[0];
  const Texture& color = desc.textures[m.color_texture.value];
  EXPECT_TRUE(color.is_srgb);
  // v points down in the file: 3 (1 - v) + 0.25 there is 1 - that here.
  EXPECT_EQ(color.u_axis.x, 2);
  EXPECT_EQ(color.v_axis.y, 3);
  EXPECT_FLOAT_EQ(color.offset.x, .5f);
  EXPECT_FLOAT_EQ(color.offset.y, 1 - 3 - .25f);
  EXPECT_EQ(m.opacity_texture.texture, m.color_texture);
  EXPECT_EQ(m.opacity_texture.channel, NumberTexture::Channel::alpha);
  const Texture& rough = desc.textures[m.roughness_texture.texture.value];
  EXPECT_FALSE(rough.is_srgb);
  EXPECT_EQ(rough.wrap_u, Texture::Wrap::clamp);
  EXPECT_EQ(rough.wrap_v, Texture::Wrap::mirror);
  EXPECT_FALSE(rough.is_mixed);
  EXPECT_TRUE(color.is_mixed);
  EXPECT_EQ(m.roughness_texture.channel, NumberTexture::Channel::green);
  EXPECT_EQ(m.metalness_texture.channel, NumberTexture::Channel::blue);
  EXPECT_FALSE(desc.textures[m.normal_texture.value].is_srgb);
  EXPECT_FLOAT_EQ(m.normal_scale, .5f);
  EXPECT_TRUE(desc.textures[m.emission_texture.value].is_srgb);
}

/// A triangle with three sets of texture coordinates, and a material that uses one picture in three places.
/// Set n says (n / 4, 0) at every corner.
class GltfUvSets : public Gltf {
 protected:
  GltfUvSets() {
    Image picture(1, 1);
    picture.pixels = {0, 1, 0};
    write_image(path("p.png"), picture);
    std::string views = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3})",
                accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                                {"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"})";
    for (int set = 0; set < 3; ++set) {
      const auto u = static_cast<float>(set) / 4;
      views +=
          R"(,{"buffer":0,"byteOffset":)" + std::to_string(source.buffer.size()) + R"(,"byteLength":24})";
      accessors += R"(,{"bufferView":)" + std::to_string(2 + set) +
                   R"(,"componentType":5126,"count":3,"type":"VEC2"})";
      append<float>(source.buffer, {u, 0, u, 0, u, 0});
    }
    source.parts["bufferViews"] = views + "]";
    source.parts["accessors"] = accessors + "]";
    source.parts["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":2,"TEXCOORD_1":3,
        "TEXCOORD_2":4},"indices":1,"material":0}]}])";
    source.parts["images"] = R"([{"uri":"p.png"}])";
    source.parts["textures"] = R"([{"source":0}])";
    source.parts["extensionsUsed"] = R"(["KHR_texture_transform","KHR_materials_clearcoat"])";
  }
  SceneDesc with_material(const std::string& material) {
    source.parts["materials"] = "[" + material + "]";
    return scene(source);
  }
  Source source;
};

TEST_F(GltfUvSets, AreReadWhereATextureLiesInThem) {
  // All in one: one set is kept, whichever it is.
  SceneDesc desc = with_material(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})");
  EXPECT_EQ(mesh(desc).uvs.at(0).x, 0);
  EXPECT_TRUE(mesh(desc).second_uvs.empty());
  desc = with_material(R"({"normalTexture":{"index":0,"texCoord":1},"occlusionTexture":{"index":0}})");
  EXPECT_EQ(mesh(desc).uvs.at(0).x, 0.25f);
  EXPECT_TRUE(mesh(desc).second_uvs.empty());
  EXPECT_FALSE(desc.textures.at(0).is_by_second_uvs);
  EXPECT_TRUE(desc.warnings.empty());

  // In two, the base color's is the first.
  desc = with_material(R"({"emissiveFactor":[1,1,1],"emissiveTexture":{"index":0},
      "pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":2}}})");
  EXPECT_TRUE(desc.warnings.empty());
  EXPECT_EQ(mesh(desc).uvs.at(0).x, 0.5f);
  EXPECT_EQ(mesh(desc).second_uvs.at(2).x, 0);
  EXPECT_EQ(mesh(desc).second_uvs.at(2).y, 1);  // v points up here
  const Material& m = desc.materials[0];
  EXPECT_FALSE(desc.textures[m.color_texture.value].is_by_second_uvs);
  EXPECT_TRUE(desc.textures[m.emission_texture.value].is_by_second_uvs);
}

TEST_F(GltfUvSets, ATransformMayNameAnotherSet) {
  const SceneDesc desc = with_material(R"({"normalTexture":{"index":0},
      "pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0,"texCoord":2,
      "extensions":{"KHR_texture_transform":{"texCoord":1}}}}})");
  EXPECT_TRUE(desc.warnings.empty());
  EXPECT_EQ(mesh(desc).uvs.at(0).x, 0.25f);
  EXPECT_EQ(mesh(desc).second_uvs.at(0).x, 0);
}

TEST_F(GltfUvSets, WhatIsTooMuchOrMissingIsNamedOnce) {
  const std::string three = R"({"normalTexture":{"index":0,"texCoord":1},
      "emissiveFactor":[1,1,1],"emissiveTexture":{"index":0,"texCoord":2},
      "pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0,"texCoord":2}}})";
  SceneDesc desc = with_material(three);
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], "material 0: more than two sets of texture coordinates");

  desc = with_material(R"({"normalTexture":{"index":0,"texCoord":5},
      "pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})");
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], "there is no TEXCOORD_5");
}

TEST_F(GltfUvSets, CoatsHaveNormalMapsOfTheirOwn) {
  const SceneDesc desc = with_material(R"({"normalTexture":{"index":0},
      "extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1,
      "clearcoatNormalTexture":{"index":0,"texCoord":1,"scale":0.5}}}})");
  EXPECT_TRUE(desc.warnings.empty());
  const Material& m = desc.materials[0];
  ASSERT_TRUE(m.coat_normal_texture.is_valid());
  EXPECT_TRUE(desc.textures[m.coat_normal_texture.value].is_by_second_uvs);
  EXPECT_FALSE(desc.textures[m.coat_normal_texture.value].is_srgb);
  EXPECT_FLOAT_EQ(m.coat_normal_scale, .5f);
  EXPECT_EQ(m.normal_scale, 1);
}

TEST_F(GltfUvSets, ColorsOfVerticesMultiplyThoseOfTheMaterial) {
  // Bytes with alpha, and floats without.
  const std::size_t bytes = source.buffer.size();
  append<std::uint8_t>(source.buffer, {255, 0, 51, 102, 0, 255, 0, 255, 0, 0, 255, 0});
  const std::size_t floats = source.buffer.size();
  append<float>(source.buffer, {1, .5f, .25f, 0, 0, 0, 1, 1, 1});
  std::string& views = source.parts["bufferViews"];
  views.pop_back();
  views += R"(,{"buffer":0,"byteLength":12,"byteOffset":)" + std::to_string(bytes) +
           R"(},{"buffer":0,"byteLength":36,"byteOffset":)" + std::to_string(floats) + "}]";
  std::string& accessors = source.parts["accessors"];
  accessors.pop_back();
  accessors += R"(,{"bufferView":5,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"},
                   {"bufferView":6,"componentType":5126,"count":3,"type":"VEC3"}])";
  source.parts["meshes"] = R"([{"primitives":[
      {"attributes":{"POSITION":0,"TEXCOORD_0":2,"COLOR_0":5},"indices":1,"material":0},
      {"attributes":{"POSITION":0,"COLOR_0":6},"indices":1},
      {"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1,"material":1}]}])";
  SceneDesc desc =
      with_material(R"({"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}},
      {"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})");
  EXPECT_TRUE(desc.warnings.empty());
  EXPECT_EQ(mesh(desc, 0).colors.at(0), (std::array<float, 4>{1, 0, 51 / 255.0f, 102 / 255.0f}));
  EXPECT_EQ(mesh(desc, 1).colors.at(0), (std::array<float, 4>{1, .5f, .25f, 1}));
  EXPECT_TRUE(mesh(desc, 2).colors.empty());

  const Material& colored = desc.materials.at(0);
  const Texture& product = desc.textures.at(colored.color_texture.value);
  ASSERT_EQ(product.kind, Texture::Kind::product);
  EXPECT_EQ(desc.textures.at(product.first.texture.value).kind, Texture::Kind::picture);
  EXPECT_EQ(desc.textures.at(product.second.texture.value).kind, Texture::Kind::vertex_color);
  EXPECT_EQ(colored.opacity_texture.texture, colored.color_texture);
  EXPECT_EQ(desc.textures.at(desc.materials.at(1).color_texture.value).kind, Texture::Kind::picture);

  // Who has no material has that of the format: white, rough metal.
  const Material& none = desc.materials.at(2);
  EXPECT_EQ(desc.geometries[1].material, MaterialId(2));
  EXPECT_EQ(none.metalness, 1);
  EXPECT_EQ(none.roughness, 1);
  EXPECT_EQ(none.color, (Vec3{1, 1, 1}));
  EXPECT_EQ(desc.textures.at(none.color_texture.value).kind, Texture::Kind::vertex_color);
}

TEST_F(Gltf, PicturesAreDecodedOnceAndMissingOnesAreWarnings) {
  // A picture of one green pixel, in a buffer view and in a data URI.
  Image green(1, 1);
  green.pixels = {0, 1, 0};
  write_image(path("green.png"), green);
  const std::string png = read(path("green.png"));
  Source source;
  source.buffer += png;
  source.parts["bufferViews"] = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3},
                                    {"buffer":0,"byteOffset":40,"byteLength":)" +
                                std::to_string(png.size()) + "}]";
  source.parts["images"] =
      R"([{"bufferView":2,"mimeType":"image/png","name":"green"},{"uri":"data:image/png;base64,)" +
      base64(png) + R"("},{"uri":"gone.png"},{"bufferView":7,"mimeType":"image/png"}])";
  source.parts["textures"] =
      R"([{"source":0},{"source":1},{"source":2},{"extensions":{"EXT_texture_webp":{"source":0}}},{"source":3}])";
  std::string materials;
  for (int i = 0; i < 5; ++i)
    materials += (i ? "," : "[") + std::string(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":)") +
                 std::to_string(i) + "}}}";
  source.parts["materials"] = materials + "]";

  // An index of a buffer view that does not exist is refused by the library itself.
  EXPECT_CONTAINS(error(source), "a.gltf");
  source.parts["images"].replace(source.parts["images"].rfind('7'), 1,
                                 "1");  // three bytes that are no picture
  const SceneDesc desc = scene(source);
  ASSERT_EQ(desc.textures.size(), 2u);
  EXPECT_EQ(desc.textures[0].name, "green");
  EXPECT_EQ(desc.textures[0].source->texel(0, 0, 0)[1], 1);
  EXPECT_EQ(desc.materials[0].color_texture, desc.materials[3].color_texture);
  EXPECT_TRUE(desc.materials[1].color_texture.is_valid());
  EXPECT_FALSE(desc.materials[2].color_texture.is_valid());
  ASSERT_EQ(desc.warnings.size(), 2u);
  EXPECT_CONTAINS(desc.warnings[0], "gone.png");
  EXPECT_CONTAINS(desc.warnings[1], "a.gltf:image 3: the picture cannot be read");
}

TEST_F(Gltf, CamerasAndLights) {
  Source source;
  source.parts["nodes"] =
      R"([{"mesh":0,"children":[1,2,3,4,5]},{"camera":0,"translation":[1,2,3],"scale":[2,2,2]},{"camera":1},
      {"translation":[0,5,0],"extensions":{"KHR_lights_punctual":{"light":0}}},
      {"rotation":[-0.70710678,0,0,0.70710678],"extensions":{"KHR_lights_punctual":{"light":1}}},
      {"translation":[7,0,0],"extensions":{"KHR_lights_punctual":{"light":2}}}])";
  source.parts["cameras"] = R"([{"type":"perspective","perspective":{"yfov":1,"znear":0.1}},
                                {"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}}])";
  source.parts["extensionsUsed"] = R"(["KHR_lights_punctual"])";
  source.parts["extensions"] =
      R"({"KHR_lights_punctual":{"lights":[{"type":"point","color":[1,0.5,0],"intensity":2},{"type":"directional"},
          {"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.5}}]}})";
  SceneDesc desc = scene(source);
  ASSERT_TRUE(desc.camera);
  EXPECT_NEAR(desc.camera->fov_deg, 57.29578, 1e-4);
  EXPECT_EQ(desc.camera->world_from_camera, Affine3::translation({1, 2, 3}));
  ASSERT_EQ(desc.point_lights.size(), 1u);
  EXPECT_EQ(desc.point_lights[0].position, (Vec3{0, 5, 0}));
  EXPECT_EQ(desc.point_lights[0].intensity, (Vec3{2, 1, 0}));
  ASSERT_EQ(desc.distant_lights.size(), 1u);
  expect_near(desc.distant_lights[0].direction, {0, -1, 0});
  ASSERT_EQ(desc.spot_lights.size(), 1u);
  EXPECT_EQ(desc.spot_lights[0].position, (Vec3{7, 0, 0}));
  expect_near(desc.spot_lights[0].direction, {0, 0, -1});
  EXPECT_NEAR(desc.spot_lights[0].inner_cosine, std::cos(.1f), 1e-6f);
  EXPECT_NEAR(desc.spot_lights[0].outer_cosine, std::cos(.5f), 1e-6f);

  // Parallel rays; the shorter side counts.
  source.parts["nodes"] = R"([{"mesh":0,"camera":0}])";
  source.parts["cameras"] =
      R"([{"type":"orthographic","orthographic":{"xmag":3,"ymag":2,"zfar":9,"znear":0.1}}])";
  EXPECT_EQ(scene(source).camera->orthographic_size, 4);
  source.parts["cameras"] =
      R"([{"type":"orthographic","orthographic":{"xmag":3,"ymag":0,"zfar":9,"znear":0.1}}])";
  EXPECT_CONTAINS(error(source), "camera 0: xmag and ymag are 3");

  // An upright picture: the angle across the shorter side is the horizontal one.
  source.parts["cameras"] =
      R"([{"type":"perspective","perspective":{"yfov":1,"aspectRatio":0.5,"znear":0.1}}])";
  source.parts["nodes"] = R"([{"mesh":0,"camera":0}])";
  EXPECT_NEAR(scene(source).camera->fov_deg, 2 * std::atan(std::tan(.5) * .5) * 57.29578, 1e-4);
}

}  // namespace
}  // namespace boxwood::io
