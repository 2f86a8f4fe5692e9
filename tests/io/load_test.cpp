// What the front door promises for every format.
#include "boxwood/io/load.h"

#include <limits>

#include "io/files.h"

namespace boxwood::io {
namespace {

using Load = Files;

const char* const kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_F(Load, KnowsFilesByTheirEndings) {
  for (const char* name : {"a.obj", "A.OBJ", "b.c.Ply", "dir/x.stl", "x.gltf", "x.GLB", "scene.pbrt"})
    EXPECT_TRUE(is_loadable(name)) << name;
  for (const char* name : {"", "obj", ".obj", "a.obj.gz", "a.png", "a", "a."})
    EXPECT_FALSE(is_loadable(name)) << name;
}

TEST_F(Load, ChoosesTheReaderInAnyCase) {
  EXPECT_EQ(defined_primitive_count(load(write("BIG.OBJ", kTriangle))), 1u);
}

TEST_F(Load, SaysWhichEndingsCanBeRead) {
  for (const char* name : {"a.xyz", "a", "a.png"}) {
    const std::string message = message_of<FileError>([&] { load(write(name, kTriangle)); });
    EXPECT_CONTAINS(message, path(name).string() + ": ");
    EXPECT_CONTAINS(message, ".obj .ply .stl .gltf .glb .pbrt");
  }
}

TEST_F(Load, NamesTheSceneAfterTheFile) {
  EXPECT_EQ(load(write("my chair.obj", kTriangle)).name, "my chair");
}

TEST_F(Load, NamesTheGeometryAndTheVertexThatIsTooFarAway) {
  const auto file = write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\ng far away\nv 0 1e38 0\nf 1 2 4\n");
  EXPECT_CONTAINS(message_of<FileError>([&] { load(file); }),
                  "a.obj: scene: geometry 1 'far away', vertex 2 is (0.000000, ");
}

TEST_F(Load, IsTheSameForAnyExecutor) {
  const auto file = write("a.obj", kTriangle);
  const SceneDesc alone = load(file), parallel = load(file, &default_executor());
  EXPECT_EQ(std::get<TriangleMesh>(alone.geometries[0].shapes).positions,
            std::get<TriangleMesh>(parallel.geometries[0].shapes).positions);
}

TEST_F(Load, ReadsPathsWithSpacesAndAccents) {
  std::filesystem::create_directory(path("Möbel und Ähnliches"));
  EXPECT_EQ(defined_primitive_count(load(write("Möbel und Ähnliches/Stühle 2.obj", kTriangle))), 1u);
}

}  // namespace
}  // namespace boxwood::io
