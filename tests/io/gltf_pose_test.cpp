// Where the meshes of a glTF file stand that skins, morph targets and instancing attributes move.
#include "io/gltf_source.h"

namespace boxwood::io {
namespace {

/// The triangle, and behind it in the buffer what a test adds.
class GltfPose : public Gltf {
 protected:
  /// Appends floats and an accessor of them; its number.
  int floats(const std::string& type, std::initializer_list<float> values, std::size_t count) {
    const std::size_t at = source_.buffer.size();
    append<float>(source_.buffer, values);
    return accessor(5126, type, count, at);
  }
  int bytes(const std::string& type, std::initializer_list<std::uint8_t> values, std::size_t count) {
    const std::size_t at = source_.buffer.size();
    append<std::uint8_t>(source_.buffer, values);
    return accessor(5121, type, count, at);
  }
  /// Two joints: the first stands still, the second 10 to the right of where it was bound, below a node that
  /// comes after the mesh.
  void add_skin() {
    const int joints = bytes("VEC4", {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 3);
    const int weights = floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 2, 2, 0, 0}, 3);  // not all add up to 1
    const int bind = floats(
        "MAT4",
        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}, 2);
    source_.parts["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":)" +
                              std::to_string(joints) + R"(,"WEIGHTS_0":)" + std::to_string(weights) +
                              R"(},"indices":1}]}])";
    source_.parts["skins"] = R"([{"joints":[1,2],"inverseBindMatrices":)" + std::to_string(bind) + "}]";
    source_.parts["nodes"] = R"([{"mesh":0,"skin":0,"translation":[0,0,77]},{},
        {"translation":[1,0,0]},{"children":[2],"translation":[10,0,0]}])";
    source_.parts["scenes"] = R"([{"nodes":[0,1,3]}])";
  }
  Source source_;

 private:
  int accessor(int component, const std::string& type, std::size_t count, std::size_t at) {
    const std::string view = std::to_string(accessors_++);
    const auto add = [&](const std::string& part, const std::string& element) {
      std::string& list = source_.parts[part];
      list.insert(list.rfind(']'), "," + element);
    };
    add("bufferViews", R"({"buffer":0,"byteOffset":)" + std::to_string(at) + R"(,"byteLength":)" +
                           std::to_string(source_.buffer.size() - at) + "}");
    add("accessors", R"({"bufferView":)" + view + R"(,"componentType":)" + std::to_string(component) +
                         R"(,"count":)" + std::to_string(count) + R"(,"type":")" + type + "\"}");
    return accessors_ - 1;
  }
  int accessors_ = 2;
};

TEST_F(GltfPose, ASkinTakesVerticesToItsJointsAndForgetsItsNode) {
  add_skin();
  const SceneDesc desc = scene(source_);
  EXPECT_TRUE(desc.warnings.empty());
  ASSERT_EQ(desc.instances.size(), 1u);
  EXPECT_TRUE(desc.instances[0].world_from_object == Affine3::identity());
  EXPECT_EQ(mesh(desc).positions, (std::vector<Vec3>{{0, 0, 0}, {11, 0, 0}, {5, 1, 0}}));
}

TEST_F(GltfPose, ASkinTurnsNormals) {
  add_skin();
  const int normals = floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
  std::string& meshes = source_.parts["meshes"];
  meshes.replace(meshes.find("\"JOINTS_0\""), 0, "\"NORMAL\":" + std::to_string(normals) + ",");
  source_.parts["nodes"] =
      R"([{"mesh":0,"skin":0},{},{"rotation":[0.70710678,0,0,0.70710678],"scale":[1,1,3]}])";
  source_.parts["scenes"] = R"([{"nodes":[0,1,2]}])";
  const SceneDesc desc = scene(source_);
  expect_near(mesh(desc).normals[0], {0, 0, 1});
  expect_near(mesh(desc).normals[1], {0, -1, 0});
}

TEST_F(GltfPose, JointsThatLeadNowhere) {
  add_skin();
  source_.parts["scenes"] = R"([{"nodes":[0,1]}])";  // without the second joint
  const SceneDesc desc = scene(source_);
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], "node 0: a joint of its skin is not in the scene");
  EXPECT_EQ(mesh(desc).positions[1], (Vec3{1, 0, 77}));

  source_.parts["skins"] = R"([{"joints":[1]}])";
  EXPECT_CONTAINS(error(source_), "JOINTS_0: vertex 1 hangs on joint 1.000000, but the skin has 1");
  source_.parts["skins"] = R"([{"joints":[9]}])";
  EXPECT_CONTAINS(error(source_), "skin 0: joint 0 is node 9, which does not exist");
  source_.parts["skins"] = R"([{"joints":[1,2,0],"inverseBindMatrices":4}])";
  EXPECT_CONTAINS(error(source_), "skin 0: there are 2 inverseBindMatrices for 3 joints");
  source_.parts["skins"] = "[]";
  EXPECT_CONTAINS(error(source_), "skin 0: the skin does not exist");
}

TEST_F(GltfPose, MorphTargetsCountByTheirWeightsAtRest) {
  const std::string target = std::to_string(floats("VEC3", {0, 0, 0, 0, 0, 4, 0, 8, 0}, 3));
  const auto positions = [&](const std::string& weights, const std::string& node) {
    source_.parts["meshes"] =
        R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1,"targets":[{"POSITION":)" + target +
        "}]}]" + weights + "}]";
    source_.parts["nodes"] = R"([{"mesh":0)" + node + "}]";
    const SceneDesc desc = scene(source_);
    EXPECT_TRUE(desc.warnings.empty());
    return mesh(desc).positions;
  };
  EXPECT_EQ(positions("", ""), (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(positions(R"(,"weights":[0.5])", ""), (std::vector<Vec3>{{0, 0, 0}, {1, 0, 2}, {0, 5, 0}}));
  EXPECT_EQ(positions(R"(,"weights":[0.5])", R"(,"weights":[1])")[1], (Vec3{1, 0, 4}));
  EXPECT_EQ(positions(R"(,"weights":[0.5])", R"(,"weights":[1],"translation":[5,0,0])")[1], (Vec3{6, 0, 4}));
  const std::string two = std::to_string(floats("VEC3", {0, 0, 0, 0, 0, 4}, 2));
  std::string& meshes = source_.parts["meshes"];
  meshes.replace(meshes.find("\"targets\":[{\"POSITION\":") + 23, target.size(), two);
  EXPECT_CONTAINS(error(source_), "target 0, POSITION: there are 2 elements, expected one for each of the 3");
}

TEST_F(GltfPose, InstancesStandByTheAttributesOfTheirNode) {
  const std::string moves = std::to_string(floats("VEC3", {1, 0, 0, 2, 0, 0}, 2)),
                    turns = std::to_string(floats("VEC4", {0, 0, 0, 1, 0, 0, 1, 0}, 2)),
                    sizes = std::to_string(floats("VEC3", {1, 1, 1, 3, 4, 5}, 2));
  const auto node = [&](const std::string& attributes) {
    return R"([{"mesh":0,"translation":[0,0,7],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{)" +
           attributes + "}}}}]";
  };
  source_.parts["extensionsRequired"] = R"(["EXT_mesh_gpu_instancing"])";
  source_.parts["nodes"] =
      node("\"TRANSLATION\":" + moves + ",\"ROTATION\":" + turns + ",\"SCALE\":" + sizes);
  const SceneDesc desc = scene(source_);
  EXPECT_TRUE(desc.warnings.empty());
  ASSERT_EQ(desc.geometries.size(), 1u);
  ASSERT_EQ(desc.instances.size(), 2u);
  expect_near(desc.instances[0].world_from_object.point({1, 0, 0}), {2, 0, 7});
  expect_near(desc.instances[1].world_from_object.point({1, 2, 1}), {-1, -8, 12});  // turned by half

  // What is no list of attributes repeats nothing.
  for (const std::string extension : {"7", "{}", R"({"attributes":[]})", R"({"attributes":{"SCALE":"x"}})"}) {
    source_.parts["nodes"] = R"([{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":)" + extension + "}}]";
    EXPECT_LE(scene(source_).instances.size(), 1u);
  }
  const std::string three = std::to_string(floats("VEC3", {1, 1, 1, 1, 1, 1, 1, 1, 1}, 3));
  source_.parts["nodes"] = node("\"TRANSLATION\":" + moves + ",\"SCALE\":" + three);
  EXPECT_CONTAINS(error(source_),
                  "node 0: TRANSLATION has 2 elements, expected one for each of the 3 copies");
}

}  // namespace
}  // namespace boxwood::io
