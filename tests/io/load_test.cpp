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

TEST_F(Load, ReadsTextBehindAByteOrderMark) {
  const std::string mark = "\xef\xbb\xbf";
  const auto first_material = [&](const std::filesystem::path& file) {
    const SceneDesc desc = load(file);
    EXPECT_TRUE(desc.warnings.empty()) << file << ": " << desc.warnings.front();
    return desc.materials.empty() ? "" : desc.materials.back().name;
  };
  write("red.mtl", mark + "newmtl red\nKd 1 0 0\n");
  EXPECT_EQ(first_material(write("a.obj", mark + "mtllib red.mtl\nusemtl red\n" + kTriangle)), "red");
  EXPECT_EQ(defined_primitive_count(load(write("b.obj", mark + kTriangle))), 1u);
  for (const auto& [name, text] :
       {std::pair{"a.ply",
                  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                  "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                  "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
        {"a.stl",
         "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
         "endloop\nendfacet\nendsolid\n"},
        {"a.pbrt", "WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n"}})
    EXPECT_EQ(defined_primitive_count(load(write(name, mark + text))), 1u) << name;
}

}  // namespace
}  // namespace boxwood::io
