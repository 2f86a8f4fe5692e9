// What a glTF or GLB file becomes, and what a broken one says.
#include <cmath>
#include <cstring>
#include <map>

#include "boxwood/core/random.h"
#include "boxwood/io/image.h"
#include "boxwood/io/load.h"
#include "boxwood/scene/scene.h"
#include "io/files.h"

namespace boxwood::io {
namespace {

std::string base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

template <class T>
void append(std::string& bytes, std::initializer_list<T> values) {
  for (const T value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A file in parts that a test can replace.
struct Source {
  std::string buffer;
  std::map<std::string, std::string> parts;  // top-level JSON members

  /// One triangle: positions at byte 0, indices (bytes) at byte 36.
  Source() {
    append<float>(buffer, {0, 0, 0, 1, 0, 0, 0, 1, 0});
    append<std::uint8_t>(buffer, {0, 1, 2, 0});
    parts = {
        {"asset", R"({"version":"2.0"})"},
        {"scenes", R"([{"nodes":[0]}])"},
        {"nodes", R"([{"mesh":0}])"},
        {"meshes", R"([{"name":"tri","primitives":[{"attributes":{"POSITION":0},"indices":1}]}])"},
        {"accessors", R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                          {"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}])"},
        {"bufferViews", R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}])"},
    };
  }
  std::string json(bool is_binary) const {
    std::string text = "{\"buffers\":[{\"byteLength\":" + std::to_string(buffer.size());
    if (!is_binary) text += ",\"uri\":\"data:application/octet-stream;base64," + base64(buffer) + "\"";
    text += "}]";
    for (const auto& [name, value] : parts) text += ",\"" + name + "\":" + value;
    return text + "}";
  }
  std::string glb() const {
    std::string text = json(true), data = buffer, out = "glTF";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4, '\0');
    append<std::uint32_t>(
        out, {2, std::uint32_t(28 + text.size() + data.size()), std::uint32_t(text.size()), 0x4e4f534a});
    out += text;
    append<std::uint32_t>(out, {std::uint32_t(data.size()), 0x004e4942});
    return out + data;
  }
};

class Gltf : public Files {
 protected:
  SceneDesc scene(const Source& source) { return load(write("a.gltf", source.json(false))); }
  std::string error(const Source& source) {
    return message_of<FileError>([&] { (void)scene(source); });
  }
  static const TriangleMesh& mesh(const SceneDesc& desc, std::size_t i = 0) {
    return std::get<TriangleMesh>(desc.geometries.at(i).shapes);
  }
};

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

void expect_near(Vec3 a, Vec3 b) {
  EXPECT_LE(length(a - b), 1e-5f) << "(" << a.x << " " << a.y << " " << a.z << ") instead of (" << b.x << " "
                                  << b.y << " " << b.z << ")";
}

TEST_F(Gltf, ReadsTextAndBinaryAlike) {
  const Source source;
  for (const SceneDesc& desc : {scene(source), load(write("b.glb", source.glb()))}) {
    EXPECT_EQ(mesh(desc).positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh(desc).indices, (Triangles{{0, 1, 2}}));
    EXPECT_EQ(desc.geometries[0].name, "tri");
    EXPECT_EQ(desc.instances.size(), 1u);
    EXPECT_TRUE(desc.warnings.empty());
  }
}

TEST_F(Gltf, ReadsBuffersFromFilesBesideIt) {
  Source source;
  const std::string text = source.json(false);
  const std::size_t begin = text.find("data:"), end = text.find('"', begin);
  std::filesystem::create_directories(path("some dir"));
  write("some dir/data.bin", source.buffer);
  EXPECT_EQ(defined_primitive_count(
                load(write("a.gltf", text.substr(0, begin) + "some%20dir/data.bin" + text.substr(end)))),
            1u);
  EXPECT_CONTAINS(message_of<FileError>([&] {
                    (void)load(write("b.gltf", text.substr(0, begin) + "gone.bin" + text.substr(end)));
                  }),
                  "gone.bin");
  EXPECT_CONTAINS(message_of<FileError>([&] {
                    (void)load(write("c.gltf", text.substr(0, begin) + "some%20dir" + text.substr(end)));
                  }),
                  "c.gltf");
}

TEST_F(Gltf, MeshesOfSeveralNodesAreReadOnceAndPlacedByTheTransformsAboveThem) {
  Source source;
  source.parts["nodes"] = R"([{"children":[1,2],"translation":[10,0,0]},
      {"mesh":0,"rotation":[0,0,0.70710678,0.70710678],"scale":[2,2,2],"translation":[0,1,0]},
      {"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,-1,0, 3,4,5,1]},{"mesh":0}])";
  const SceneDesc desc = scene(source);
  ASSERT_EQ(desc.geometries.size(), 1u);
  ASSERT_EQ(desc.instances.size(), 2u);  // the last node is in no scene
  expect_near(desc.instances[0].world_from_object.point({1, 0, 0}), {10, 3, 0});
  expect_near(desc.instances[1].world_from_object.point({1, 0, 1}), {14, 4, 4});

  // Without scenes, every node that has no parent is shown.
  source.parts.erase("scenes");
  EXPECT_EQ(scene(source).instances.size(), 3u);
}

TEST_F(Gltf, ReadsStripsFansAndMissingIndices) {
  Source source;
  source.buffer.clear();
  append<float>(source.buffer, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  source.parts["bufferViews"] = R"([{"buffer":0,"byteLength":60}])";
  source.parts["accessors"] = R"([{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"}])";
  source.parts["meshes"] =
      R"([{"primitives":[{"attributes":{"POSITION":0},"mode":5},{"attributes":{"POSITION":0},"mode":6},
                                              {"attributes":{"POSITION":0}},{"attributes":{"POSITION":0},"mode":1}]}])";
  const SceneDesc desc = scene(source);
  ASSERT_EQ(desc.geometries.size(), 3u);
  EXPECT_EQ(mesh(desc, 0).indices, (Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(mesh(desc, 1).indices, (Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
  EXPECT_EQ(mesh(desc, 2).indices, (Triangles{{0, 1, 2}}));
  ASSERT_EQ(desc.warnings.size(), 2u);
  EXPECT_CONTAINS(desc.warnings[0], "mesh 0, primitive 2: the last triangle has only 2 vertices");
  EXPECT_CONTAINS(desc.warnings[1], "mesh 0, primitive 3: points and lines");
}

TEST_F(Gltf, ReadsInterleavedAndNormalizedAttributes) {
  Source source;
  source.buffer.clear();
  for (int i = 0; i < 3;
       ++i) {  // 24 bytes a vertex: position as shorts, normal as bytes, uv as normalized shorts
    append<std::int16_t>(source.buffer,
                         {std::int16_t(100 * i), std::int16_t(i == 1 ? -200 : 0), std::int16_t(i * i), 0});
    append<std::int8_t>(source.buffer, {0, -128, 127, 0});
    append<std::uint16_t>(source.buffer, {65535, std::uint16_t(i == 0 ? 0 : 13107)});
    append<std::uint32_t>(source.buffer, {std::uint32_t(2 - i), 0});
  }
  source.parts["extensionsUsed"] = source.parts["extensionsRequired"] = R"(["KHR_mesh_quantization"])";
  source.parts["bufferViews"] = R"([{"buffer":0,"byteLength":72,"byteStride":24}])";
  source.parts["accessors"] = R"([{"bufferView":0,"componentType":5122,"count":3,"type":"VEC3"},
      {"bufferView":0,"byteOffset":8,"componentType":5120,"normalized":true,"count":3,"type":"VEC3"},
      {"bufferView":0,"byteOffset":12,"componentType":5123,"normalized":true,"count":3,"type":"VEC2"},
      {"bufferView":0,"byteOffset":16,"componentType":5125,"count":3,"type":"SCALAR"}])";
  source.parts["meshes"] =
      R"([{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3}]}])";
  const SceneDesc desc = scene(source);
  EXPECT_EQ(mesh(desc).positions, (std::vector<Vec3>{{0, 0, 0}, {100, -200, 1}, {200, 0, 4}}));
  EXPECT_EQ(mesh(desc).normals[0], (Vec3{0, -1, 1}));
  EXPECT_EQ(mesh(desc).uvs[0], (Vec2{1, 1}));  // v points up here
  EXPECT_FLOAT_EQ(mesh(desc).uvs[1].y, .8f);
  EXPECT_EQ(mesh(desc).indices, (Triangles{{2, 1, 0}}));
}

TEST_F(Gltf, SparseAccessorsReplaceElementsOfAViewOrOfZeros) {
  Source source;
  append<std::uint16_t>(source.buffer, {1, 2});       // byte 40: which
  append<float>(source.buffer, {5, 6, 7, 8, 9, 10});  // byte 44: by what
  source.parts["bufferViews"] = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3},
                                    {"buffer":0,"byteOffset":40,"byteLength":4},{"buffer":0,"byteOffset":44,"byteLength":24}])";
  const std::string sparse =
      R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":2,"componentType":5123},"values":{"bufferView":3}}})";
  const std::string indices = R"({"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}])";
  source.parts["accessors"] = "[{\"bufferView\":0," + sparse + "," + indices;
  EXPECT_EQ(mesh(scene(source)).positions, (std::vector<Vec3>{{0, 0, 0}, {5, 6, 7}, {8, 9, 10}}));
  source.parts["accessors"] = "[{" + sparse + "," + indices;
  EXPECT_EQ(mesh(scene(source)).positions, (std::vector<Vec3>{{0, 0, 0}, {5, 6, 7}, {8, 9, 10}}));

  source.buffer[42] = 3;
  EXPECT_CONTAINS(
      error(source),
      "a.gltf:mesh 0 'tri', primitive 0, POSITION, accessor 0, sparse: index 1 is 3, but there are 3");
}

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
  source.parts["samplers"] = R"([{"wrapS":33071,"wrapT":33648}])";
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
  EXPECT_EQ(m.roughness_texture.channel, NumberTexture::Channel::green);
  EXPECT_EQ(m.metalness_texture.channel, NumberTexture::Channel::blue);
  EXPECT_FALSE(desc.textures[m.normal_texture.value].is_srgb);
  EXPECT_FLOAT_EQ(m.normal_scale, .5f);
  EXPECT_TRUE(desc.textures[m.emission_texture.value].is_srgb);
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
  source.parts["textures"] = R"([{"source":0},{"source":1},{"source":2},{"source":0},{"source":3}])";
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
  EXPECT_EQ(desc.textures[0].texels[0][1], 255);
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

  // An upright picture: the angle across the shorter side is the horizontal one.
  source.parts["cameras"] =
      R"([{"type":"perspective","perspective":{"yfov":1,"aspectRatio":0.5,"znear":0.1}}])";
  source.parts["nodes"] = R"([{"mesh":0,"camera":0}])";
  EXPECT_NEAR(scene(source).camera->fov_deg, 2 * std::atan(std::tan(.5) * .5) * 57.29578, 1e-4);
}

TEST_F(Gltf, WhatIsNotSupportedIsNamed) {
  Source source;
  source.parts["extensionsUsed"] = R"(["KHR_materials_iridescence"])";
  source.parts["animations"] = R"([{"channels":[],"samplers":[]}])";
  source.parts["nodes"] = R"([{"mesh":0,"children":[1]},{"mesh":0,"scale":[0,1,1]}])";
  const SceneDesc desc = scene(source);
  EXPECT_EQ(desc.instances.size(), 1u);
  ASSERT_GE(desc.warnings.size(), 2u);
  EXPECT_CONTAINS(desc.warnings[0], "the extension KHR_materials_iridescence is not supported");
  EXPECT_CONTAINS(desc.warnings[1], "a.gltf:node 1: the transform flattens its mesh");

  source.parts["extensionsRequired"] = R"(["KHR_draco_mesh_compression"])";
  EXPECT_CONTAINS(error(source), "requires the extension KHR_draco_mesh_compression");
}

TEST_F(Gltf, ErrorsNameTheElementAndTheNumber) {
  const auto expect_error = [&](const std::string& part, const std::string& value,
                                const std::string& expected) {
    Source source;
    source.parts[part] = value;
    EXPECT_CONTAINS(error(source), expected);
    EXPECT_CONTAINS(error(source), path("a.gltf").string());
  };
  const std::string primitive = "a.gltf:mesh 0 'tri', primitive 0, ";
  expect_error("asset", R"({"version":"1.0"})", "this is glTF version 1.0");
  expect_error("asset", "7", "not a glTF file");
  expect_error("scene", "3", "scene 3 does not exist, there are 1");
  expect_error("scenes", R"([{"nodes":[4]}])", "node 4: the node does not exist, there are 1");
  expect_error("nodes", R"([{"mesh":0,"children":[0]}])", "node 0: the node is reached twice");
  expect_error("nodes", R"([{"children":[1]},{"children":[2]},{"children":[1],"mesh":0}])",
               "node 1: the node is reached twice");
  expect_error("nodes", R"([{"mesh":3}])", "node 0: mesh 3 does not exist");
  expect_error("nodes", R"([{"mesh":0,"translation":[1,2]}])", "translation has 2 numbers, expected 3");
  expect_error("nodes", R"([{"mesh":0,"rotation":[0,0,0,0]}])", "quaternion of no length");
  expect_error("nodes", R"([{"mesh":0,"matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}])", "not affine");
  expect_error("nodes", R"([{"mesh":0,"translation":[1e200,0,0]}])", "node 0: the transform is not finite");
  expect_error(
      "accessors",
      R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}])",
      primitive +
          "POSITION, accessor 0: 4 elements of 12 bytes, 12 apart, from byte 0 do not fit into the 36 bytes "
          "of buffer view 0");
  expect_error(
      "accessors",
      R"([{"bufferView":0,"componentType":5126,"count":18446744073709551615,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}])",
      "do not fit");
  expect_error(
      "accessors",
      R"([{"componentType":5126,"count":18446744073709551615,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}])",
      "and no buffer view");
  expect_error(
      "accessors",
      R"([{"bufferView":0,"byteOffset":18446744073709551612,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}])",
      "do not fit");
  expect_error(
      "accessors",
      R"([{"bufferView":0,"componentType":5126,"count":2,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}])",
      primitive + "indices, accessor 1: index 2 is 2, but there are 2 vertices");
  expect_error(
      "accessors",
      R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"},{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}])",
      "expected VEC3");
  expect_error(
      "accessors",
      R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5120,"count":3,"type":"SCALAR"}])",
      "expected scalar unsigned integers");
  expect_error(
      "accessors",
      R"([{"bufferView":5,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}])",
      "buffer view 5 does not exist, there are 2");
  expect_error("bufferViews",
               R"([{"buffer":0,"byteLength":37,"byteOffset":4},{"buffer":0,"byteOffset":36,"byteLength":3}])",
               "buffer view 0 takes 37 bytes from byte 4, but buffer 0 has 40");
  expect_error("bufferViews",
               R"([{"buffer":0,"byteLength":36,"byteStride":8},{"buffer":0,"byteOffset":36,"byteLength":3}])",
               "stride of 8 bytes, expected at least the 12");
  expect_error("bufferViews", R"([{"buffer":1,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}])",
               "but there are 1");
  expect_error("meshes", R"([{"primitives":[{"attributes":{"POSITION":9}}]}])",
               "mesh 0, primitive 0, POSITION, accessor 9: accessor 9 does not exist, there are 2");
  expect_error("meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"mode":9}]}])", "the mode is 9");
  expect_error("meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"material":0}]}])",
               "material 0 does not exist, there are 0");
  expect_error("meshes", R"([{"primitives":[{"attributes":{"NORMAL":0}}]}])", "no triangle");

  Source source;
  const float nan = std::nanf("");
  std::memcpy(&source.buffer[16], &nan, sizeof nan);
  EXPECT_CONTAINS(error(source), primitive + "POSITION, accessor 0: element 1, number 1 is");
}

TEST_F(Gltf, NestingWithoutEndIsAnError) {
  Source source;
  source.parts["extras"] = std::string(200000, '[') + std::string(200000, ']');
  EXPECT_CONTAINS(error(source), "nested deeper");

  // A chain of nodes is no recursion.
  std::string nodes = "[";
  constexpr int kNodes = 50000;
  for (int i = 0; i < kNodes; ++i) nodes += "{\"children\":[" + std::to_string(i + 1) + "]},";
  source.parts.erase("extras");
  source.parts["nodes"] = nodes + "{\"mesh\":0}]";
  EXPECT_EQ(scene(source).instances.size(), 1u);
}

TEST_F(Gltf, EveryTruncationOfABinaryFileIsAnError) {
  const std::string whole = Source().glb();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto file = write("cut.glb", whole.substr(0, length));
    EXPECT_CONTAINS(message_of<FileError>([&] { (void)load(file); }), "cut.glb");
  }

  // Also when the header claims what the file has.
  for (std::uint32_t length = 12; length < whole.size(); ++length) {
    std::string cut = whole.substr(0, length);
    std::memcpy(&cut[8], &length, 4);
    const auto file = write("cut.glb", cut);
    EXPECT_CONTAINS(message_of<FileError>([&] { (void)load(file); }), "cut.glb");
  }
}

TEST_F(Gltf, RandomDamageIsAnErrorOrASceneButNeverACrash) {
  Source source;
  append<std::uint16_t>(source.buffer, {1, 2});
  append<float>(source.buffer, {5, 6, 7, 8, 9, 10});
  source.parts["bufferViews"] = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3},
      {"buffer":0,"byteOffset":40,"byteLength":4},{"buffer":0,"byteOffset":44,"byteLength":24,"byteStride":12}])";
  source.parts["accessors"] =
      R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"sparse":
      {"count":2,"indices":{"bufferView":2,"componentType":5123},"values":{"bufferView":3}}},
      {"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}])";
  source.parts["meshes"] =
      R"([{"name":"m","primitives":[{"attributes":{"POSITION":0,"NORMAL":0},"indices":1,"material":0,"targets":[{"POSITION":0}]}]}])";
  source.parts["nodes"] = R"([{"mesh":0,"children":[1],"rotation":[0,0,0,1],"extras":{"a":[1,{"b":null}]}},
      {"camera":0,"skin":0,"scale":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":0}}}])";
  source.parts["cameras"] = R"([{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}])";
  source.parts["extensions"] =
      R"({"KHR_lights_punctual":{"lights":[{"type":"point","color":[1,0.5,0],"intensity":2}]}})";
  source.parts["images"] =
      R"([{"bufferView":2,"mimeType":"image/png"},{"uri":"data:image/png;base64,AAAA"}])";
  source.parts["textures"] = R"([{"source":0},{"source":1}])";
  source.parts["samplers"] = R"([{"wrapS":10497}])";
  source.parts["skins"] = R"([{"joints":[0]}])";
  source.parts["animations"] =
      R"([{"channels":[{"sampler":0,"target":{"node":0,"path":"scale"}}],"samplers":[{"input":1,"output":0}]}])";
  source.parts["materials"] =
      R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":1}},
      "emissiveFactor":[1,1,1],"extensions":{"KHR_materials_ior":{"ior":1.2}}}])";
  const std::string text = source.json(false), binary = source.glb();
  ASSERT_EQ(shown_primitive_count(load(write("a.gltf", text))), 1u);
  ASSERT_EQ(shown_primitive_count(load(write("b.glb", binary))), 1u);

  Random random(2);
  const char* words[] = {
      "-1", "0",    "99999999999", "1e999", "1.5", "null", "true",       "{}",
      "[]", "\"\"", "\"x\"",       "[[",    "}",   "\xff", "4294967295", "18446744073709551615"};
  int errors = 0;
  for (int round = 0; round < 3000; ++round) {
    const bool is_binary = round % 3 == 2;
    std::string bytes = is_binary ? binary : text;
    for (std::uint32_t edits = 1 + random.below(3); edits > 0; --edits) {
      const std::size_t at = random.below(static_cast<std::uint32_t>(bytes.size()));
      const std::string word = words[random.below(std::size(words))];
      switch (random.below(is_binary ? 2 : 5)) {
        case 0:
          bytes[at] = static_cast<char>(random.below(256));
          break;
        case 1:  // in place of as many bytes, so that a GLB stays whole
          for (std::size_t i = 0; i < word.size() && at + i < bytes.size(); ++i) bytes[at + i] = word[i];
          break;
        case 2:
          bytes.erase(at, 1 + random.below(20));
          break;
        case 3:
          bytes.insert(at, word);
          break;
        default: {  // a whole value of the JSON
          const std::size_t colon = bytes.find(':', at), end = bytes.find_first_of(",}]", colon);
          if (end != std::string::npos) bytes.replace(colon + 1, end - colon - 1, word);
        }
      }
    }
    const auto file = write(is_binary ? "d.glb" : "d.gltf", bytes);
    const std::string message = message_of<FileError>([&] { (void)load(file); });
    errors += !message.empty();
    if (!message.empty()) {
      EXPECT_CONTAINS(message, file.string());
    }
  }
  EXPECT_GT(errors, 1000);
}

TEST_F(Gltf, TheRealModelsLoad) {
  BOXWOOD_NEEDS_MODELS();
  struct Expected {
    const char* name;
    std::size_t triangles, geometries, instances, textures;
  };
  for (const Expected& e :
       {Expected{"Duck.glb", 4212, 1, 1, 1}, Expected{"CesiumMilkTruck.glb", 2856, 4, 5, 1},
        Expected{"BoxTextured.glb", 12, 1, 1, 1}, Expected{"BoxInterleaved.glb", 12, 1, 1, 0}}) {
    const SceneDesc desc = load(std::filesystem::path(models_folder()) / e.name);
    EXPECT_EQ(defined_primitive_count(desc), e.triangles) << e.name;
    EXPECT_EQ(desc.geometries.size(), e.geometries) << e.name;
    EXPECT_EQ(desc.instances.size(), e.instances) << e.name;
    EXPECT_EQ(desc.textures.size(), e.textures) << e.name;
    for (std::size_t g = 0; g < desc.geometries.size(); ++g)
      EXPECT_FALSE(mesh(desc, g).normals.empty()) << e.name;
  }

  // The box stands within half a unit of the origin on every side.
  const Box3 bounds = Scene(load(std::filesystem::path(models_folder()) / "BoxTextured.glb")).bounds();
  expect_near(bounds.lower, {-.5f, -.5f, -.5f});
  expect_near(bounds.upper, {.5f, .5f, .5f});
}

}  // namespace
}  // namespace boxwood::io
