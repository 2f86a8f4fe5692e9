// What a glTF or GLB file becomes: its meshes, nodes and accessors.
#include "boxwood/scene/scene.h"
#include "io/gltf_source.h"

namespace boxwood::io {
namespace {

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

TEST_F(Gltf, AMeshInOnePlaceIsPutThere) {
  Source source;
  append<float>(source.buffer, {0, 0, 1, 0, 0, 1, 0.6f, 0, 0.8f});
  source.parts["bufferViews"] =
      R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3},{"buffer":0,"byteOffset":40,"byteLength":36}])";
  source.parts["accessors"].replace(source.parts["accessors"].rfind(']'), 1,
                                    R"(,{"bufferView":2,"componentType":5126,"count":3,"type":"VEC3"}])");
  source.parts["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0,"NORMAL":2},"indices":1}]}])";
  const auto placed = [&](const std::string& node) {
    source.parts["nodes"] = R"([{"mesh":0,)" + node + "}]";
    return scene(source);
  };

  const SceneDesc moved = placed(R"("translation":[10,20,30],"scale":[1,1,2])");
  EXPECT_TRUE(moved.instances.at(0).world_from_object == Affine3::identity());
  EXPECT_EQ(mesh(moved).positions, (std::vector<Vec3>{{10, 20, 30}, {11, 20, 30}, {10, 21, 30}}));
  expect_near(mesh(moved).normals[1], {0, 0, 1});
  expect_near(mesh(moved).normals[2], normalize(Vec3{0.6f, 0, 0.4f}));

  // Front sides would be back sides; floats are too coarse.
  for (const std::string node : {R"("scale":[-1,1,1])", R"("translation":[1e6,0,0])"}) {
    const SceneDesc kept = placed(node);
    EXPECT_FALSE(kept.instances.at(0).world_from_object == Affine3::identity());
    EXPECT_EQ(mesh(kept).positions[1], (Vec3{1, 0, 0}));
  }
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
