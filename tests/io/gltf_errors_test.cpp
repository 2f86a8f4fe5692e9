// What the glTF reader says of what it does not support, and of what is broken.
#include <cstring>

#include "boxwood/core/random.h"
#include "io/gltf_source.h"

namespace boxwood::io {
namespace {

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

TEST_F(Gltf, WhatIsCompressedIsCalledSo) {
  // Its accessors have no views: the library stumbles over them before it has read what the file requires.
  Source source;
  source.parts["accessors"] =
      R"([{"componentType":5126,"count":3,"type":"VEC3"},{"componentType":5121,"count":3,"type":"SCALAR"}])";
  EXPECT_CONTAINS(error(source), "not a glTF file that can be read");
  source.parts["extensionsRequired"] = R"([ "KHR_texture_transform" , "KHR_draco_mesh_compression" ])";
  EXPECT_CONTAINS(error(source),
                  "a.gltf:extensionsRequired: the file requires the extension KHR_draco_mesh_compression, "
                  "which is not supported");
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
  source.parts["nodes"] =
      R"([{"mesh":0,"children":[1,2],"rotation":[0,0,0,1],"extras":{"a":[1,{"b":null}]},"weights":[0.5],
      "extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}},
      {"camera":0,"skin":0,"scale":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":0}}},{"mesh":0,"skin":0}])";
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
  ASSERT_EQ(shown_primitive_count(load(write("a.gltf", text))), 4u);  // three copies, and one with a skin
  ASSERT_EQ(shown_primitive_count(load(write("b.glb", binary))), 4u);

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

}  // namespace
}  // namespace boxwood::io
