// What `boxwood info` says of a scene, to people and to programs.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "boxwood/core/error.h"
#include "boxwood/gallery/gallery.h"
#include "commands.h"
#include "scene_report.h"

namespace boxwood::app {
namespace {

namespace fs = std::filesystem;

/// Two triangles that stand in the world and once more beside it, three balls, and some of everything else.
SceneDesc small_scene() {
  SceneDesc desc;
  desc.name = "small";
  const TextureId texture =
      desc.add(Texture{"white", 2, 3, std::vector<std::array<std::uint8_t, 4>>(6), true});
  const MaterialId lamp = desc.add(Material{.kind = Material::Kind::matte, .emission = {1, 1, 1}});
  const MaterialId steel = desc.add(Material{.kind = Material::Kind::metal, .color_texture = texture});
  desc.add(Material{.kind = Material::Kind::metal});

  TriangleMesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                    .indices = {{0, 1, 2}, {0, 2, 3}}};
  const GeometryId wing = desc.add(Geometry{std::move(mesh), steel, {}, "wing"});
  const GeometryId balls =
      desc.add(std::vector<Sphere>{{{0, 0, 5}, 1}, {{0, 0, 9}, 1}, {{0, 0, 13}, 1}}, lamp);
  desc.add(Instance{wing, Affine3::identity()});
  desc.add(Instance{wing, Affine3::translation({5, 0, 0})});
  desc.add(Instance{balls, Affine3::identity()});
  desc.point_lights.push_back({{0, 9, 0}, {1, 1, 1}});
  desc.warnings.push_back("something was left out");
  return desc;
}

TEST(SceneReport, CountsWhatIsThere) {
  const SceneReport found = report(Scene(small_scene()), serial_executor());
  EXPECT_EQ(found.name, "small");
  EXPECT_EQ(found.geometries, (std::map<std::string, std::size_t>{{"spheres", 1}, {"triangles", 1}}));
  EXPECT_EQ(found.primitives, (std::map<std::string, std::size_t>{{"spheres", 3}, {"triangles", 2}}));
  EXPECT_EQ(found.defined_primitives, 5u);
  EXPECT_EQ(found.shown_primitives, 7u);
  EXPECT_EQ(found.instances, 3u);
  EXPECT_EQ(found.materials, (std::map<std::string, std::size_t>{{"matte", 1}, {"metal", 2}}));
  EXPECT_EQ(found.emissive_materials, 1u);
  EXPECT_EQ(found.textures, 1u);
  EXPECT_EQ(found.texels, 6u);
  EXPECT_EQ(found.texture_bytes, 24u);
  EXPECT_EQ(found.point_lights, 1u);
  EXPECT_EQ(found.distant_lights, 0u);
  EXPECT_FALSE(found.has_sky);
  EXPECT_TRUE(found.bounds.contains(Box3{{-1, -1, 0}, {6, 1, 14}}));
  EXPECT_TRUE((Box3{{-1.001f, -1.001f, -0.001f}, {6.001f, 1.001f, 14.001f}}).contains(found.bounds));
  EXPECT_EQ(found.warnings.size(), 1u);
}

TEST(SceneReport, NamesEachTree) {
  const SceneReport found = report(Scene(small_scene()), serial_executor());
  std::vector<std::pair<std::string, std::size_t>> trees;
  for (const TreeReport& tree : found.trees) trees.emplace_back(tree.name, tree.shape.primitive_count);
  const std::vector<std::pair<std::string, std::size_t>> expected{
      {"world: triangles", 2}, {"world: shapes", 3}, {"object 0 'wing': triangles", 2}, {"instances", 1}};
  EXPECT_EQ(trees, expected);
}

TEST(SceneReport, TreesAddUp) {
  const Scene scene(gallery::make("city:100"));
  const SceneReport found = report(scene, default_executor());
  std::size_t bytes = 0, primitives = 0;
  for (const TreeReport& tree : found.trees) {
    bytes += tree.shape.size_bytes;
    std::size_t in_leaves = 0;
    for (std::size_t size = 0; size < tree.shape.leaves_of_size.size(); ++size)
      in_leaves += size * tree.shape.leaves_of_size[size];
    EXPECT_EQ(in_leaves, tree.shape.primitive_count) << tree.name;
    EXPECT_GT(tree.sah_cost, 0) << tree.name;
    if (tree.name != "instances") primitives += in_leaves;
  }
  EXPECT_EQ(bytes, scene.statistics().tree_bytes);
  EXPECT_EQ(primitives, found.defined_primitives);
}

TEST(SceneReport, AnEmptySceneHasNoTrees) {
  const SceneReport found = report(Scene(SceneDesc{}), serial_executor());
  EXPECT_TRUE(found.trees.empty());
  EXPECT_TRUE(found.bounds.is_empty());
  EXPECT_EQ(found.shown_primitives, 0u);
}

TEST(SceneReport, LeavesOutAnOverlapThatWouldTakeForEver) {
  const SceneReport few = report(Scene(gallery::make("duplicates:100")), serial_executor());
  EXPECT_TRUE(few.trees.at(0).end_point_overlap.has_value());
  const SceneReport many = report(Scene(gallery::make("duplicates:100000")), serial_executor());
  EXPECT_FALSE(many.trees.at(0).end_point_overlap.has_value());
}

class InfoCommand : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// Runs `boxwood info ...` in this process and returns what it printed.
  static std::string run(const std::string& arguments) {
    CLI::App program;
    add_info(program);
    testing::internal::CaptureStdout();
    try {
      program.parse("info " + arguments);
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    return testing::internal::GetCapturedStdout();
  }

  fs::path folder_ = fs::path(testing::TempDir()) / "boxwood_info_test";
};

TEST_F(InfoCommand, SaysTheSameToPeopleAndPrograms) {
  const fs::path json_path = folder_ / "info.json";
  const std::string text = run("spheres:12345 --quiet --json " + json_path.string());
  EXPECT_NE(text.find("12,345   defined: 12,345 spheres"), std::string::npos) << text;

  const auto json = nlohmann::json::parse(std::ifstream(json_path));
  EXPECT_EQ(json.at("primitives").at("shown"), 12345);
  EXPECT_EQ(json.at("primitives").at("by_kind").at("spheres"), 12345);
  ASSERT_EQ(json.at("trees").size(), 1u);
  const auto& tree = json.at("trees")[0];
  EXPECT_EQ(tree.at("name"), "world: shapes");
  EXPECT_EQ(tree.at("nodes").get<int>(), 2 * tree.at("leaves").get<int>() - 1);
  EXPECT_GT(tree.at("end_point_overlap").get<double>(), 0);
  EXPECT_EQ(json.at("tree_bytes"), tree.at("size_bytes"));
  EXPECT_TRUE(json.contains("bounds") && json.contains("camera") && json.contains("build_ms"));
}

TEST_F(InfoCommand, EveryLineFitsATerminal) {
  for (const gallery::Entry& entry : gallery::entries()) {
    std::istringstream text(run(std::string(entry.name) + " --quiet"));
    for (std::string line; std::getline(text, line);) {
      EXPECT_LE(line.size(), 120u) << line;
      EXPECT_TRUE(line.empty() || line.back() != ' ') << '"' << line << '"';
    }
  }
}

TEST_F(InfoCommand, RefusesWhatCannotWork) {
  EXPECT_THROW(run("nosuchscene --quiet"), FileError);
  EXPECT_THROW(run("spheres:many --quiet"), std::invalid_argument);
  EXPECT_THROW(run("spheres:10 --quiet --json " + (folder_ / "missing" / "a.json").string()), FileError);
  EXPECT_THROW(run("spheres:10 --quiet --json " + folder_.string()), FileError);
  EXPECT_THROW(run("--build quick"), CLI::ParseError);
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace boxwood::app
