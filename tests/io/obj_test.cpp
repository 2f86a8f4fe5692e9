// What a Wavefront OBJ file becomes.
#include "boxwood/io/image.h"
#include "boxwood/io/load.h"
#include "io/files.h"

namespace boxwood::io {
namespace {

using Obj = Files;

const TriangleMesh& mesh_of(const SceneDesc& desc, std::size_t geometry = 0) {
  return std::get<TriangleMesh>(desc.geometries.at(geometry).shapes);
}

float area_of(const TriangleMesh& mesh) {
  float area = 0;
  for (const auto& [a, b, c] : mesh.indices)
    area += length(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a])) / 2;
  return area;
}

TEST_F(Obj, SharesVerticesAndKeepsTheNearestFloats) {
  const SceneDesc desc = load(write("quad.obj",
                                    "# a comment\r\nv 0 0 0\r\nv +1.1 0 0\r\nv 1 1e0 -0.1\r\nv 0 1 0\r\n"
                                    "f 1 2 3\r\nf 1 3 4 # the rest\r\n"));
  const TriangleMesh& mesh = mesh_of(desc);
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1.1f, 0, 0}, {1, 1, -0.1f}, {0, 1, 0}}));
  EXPECT_EQ(mesh.indices, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.uvs.empty());
  EXPECT_TRUE(desc.warnings.empty());
  EXPECT_EQ(desc.name, "quad");
}

TEST_F(Obj, PicturesCutHoles) {
  Image grey(1, 1);
  grey.pixels = {0.5f, 0.5f, 0.5f};
  write_image(path("a.png"), grey);
  write_image(path("b.png"), grey);
  write(
      "m.mtl",
      "newmtl leaf\nmap_Kd a.png\nmap_d a.png\nnewmtl fence\nmap_Kd a.png\nmap_d b.png\nnewmtl wall\nmap_Kd "
      "a.png\nnewmtl gone\nmap_d gone.png\n");
  const SceneDesc desc = load(write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  ASSERT_EQ(desc.materials.size(), 4u);
  EXPECT_EQ(desc.materials[0].opacity_texture.texture, desc.materials[0].color_texture);
  EXPECT_EQ(desc.materials[0].opacity_texture.channel, NumberTexture::Channel::alpha);
  const NumberTexture& fence = desc.materials[1].opacity_texture;
  EXPECT_EQ(fence.channel, NumberTexture::Channel::mean);
  EXPECT_FALSE(desc.textures.at(fence.texture.value).is_srgb);  // shares, not light
  EXPECT_TRUE(desc.textures.at(desc.materials[1].color_texture.value).is_srgb);
  EXPECT_FALSE(desc.materials[2].opacity_texture.texture.is_valid());
  EXPECT_FALSE(desc.materials[3].opacity_texture.texture.is_valid());
  ASSERT_EQ(desc.warnings.size(), 1u);
  EXPECT_CONTAINS(desc.warnings[0], "gone.png");
}

TEST_F(Obj, VerticesHaveColors) {
  // The first has none, the third a weight before its color.
  const SceneDesc desc = load(write("colors.obj",
                                    "v 0 0 0\nv 1 0 0 1 0 .7353569\nv 0 1 0 1 0 1 0\nv 1 1 0 1\n"
                                    "f 1 2 3\nf 3 2 4\n"));
  const TriangleMesh& mesh = mesh_of(desc);
  ASSERT_EQ(mesh.colors.size(), 4u);
  EXPECT_EQ(mesh.colors[0], (std::array<float, 4>{1, 1, 1, 1}));
  EXPECT_EQ(mesh.colors[1][0], 1);
  EXPECT_EQ(mesh.colors[1][1], 0);
  EXPECT_NEAR(mesh.colors[1][2], 0.5f, 1e-3f);
  EXPECT_EQ(mesh.colors[2], (std::array<float, 4>{0, 1, 0, 1}));
  EXPECT_EQ(mesh.colors[3], (std::array<float, 4>{1, 1, 1, 1}));
  const Material& material = desc.materials.at(desc.geometries[0].material.value);
  EXPECT_EQ(desc.textures.at(material.color_texture.value).kind, Texture::Kind::vertex_color);
}

TEST_F(Obj, ColorsOfVerticesMultiplyTheirMaterial) {
  write("m.mtl", "newmtl red\nKd 1 0 0\n");
  const SceneDesc desc = load(
      write("m.obj", "mtllib m.mtl\nv 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 0 1 0 1 1 1\nusemtl red\nf 1 2 3\n"));
  const Material& material = desc.materials.at(desc.geometries.at(0).material.value);
  EXPECT_EQ(material.color, (Vec3{1, 0, 0}));
  EXPECT_EQ(desc.textures.at(material.color_texture.value).kind, Texture::Kind::vertex_color);
  EXPECT_EQ(desc.materials.size(), 1u);
}

TEST_F(Obj, CountsNegativeIndicesBackFromTheNewestVertex) {
  const SceneDesc desc =
      load(write("a.obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -4 -3 -1\n"));
  const TriangleMesh& mesh = mesh_of(desc);
  ASSERT_EQ(mesh.indices.size(), 2u);
  EXPECT_EQ(mesh.positions[mesh.indices[0][0]], (Vec3{0, 0, 0}));
  EXPECT_EQ(mesh.positions[mesh.indices[1][2]], (Vec3{5, 5, 5}));
  EXPECT_EQ(mesh.positions.size(), 4u);
}

TEST_F(Obj, JoinsEqualCornersOnly) {
  const SceneDesc desc =
      load(write("a.obj",
                 "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0.5\nvn 0 0 1\nvn 0 1 0\n"
                 "f 1/1/1 2/2/1 3/1/1\nf 1/1/1 3/1/1 4//1\nf 1/1/2 3/1/1 4//1\n"));
  const TriangleMesh& mesh = mesh_of(desc);
  EXPECT_EQ(mesh.positions.size(), 5u);
  ASSERT_EQ(mesh.normals.size(), 5u);
  ASSERT_EQ(mesh.uvs.size(), 5u);
  EXPECT_NE(mesh.indices[0][0], mesh.indices[2][0]);
  EXPECT_EQ(mesh.positions[mesh.indices[0][0]], mesh.positions[mesh.indices[2][0]]);
  EXPECT_EQ(mesh.normals[mesh.indices[2][0]], (Vec3{0, 1, 0}));
  EXPECT_EQ(mesh.uvs[mesh.indices[0][1]], (Vec2{1, 0.5f}));
  EXPECT_EQ(mesh.uvs[mesh.indices[1][2]], (Vec2{0, 0}));
}

TEST_F(Obj, FillsPolygonsConcaveOnesToo) {
  // A pentagon with a dent, seen from below, beginning at each of its corners in turn.
  const std::string vertices = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\n";
  for (int first = 0; first < 5; ++first) {
    std::string face = "f";
    for (int i = 0; i < 5; ++i) face += " " + std::to_string(5 - (first + i) % 5);
    const SceneDesc desc = load(write("a.obj", vertices + face + "\n"));
    ASSERT_EQ(mesh_of(desc).indices.size(), 3u);
    EXPECT_FLOAT_EQ(area_of(mesh_of(desc)), 10) << face;
    for (const auto& [a, b, c] : mesh_of(desc).indices) {
      const auto& p = mesh_of(desc).positions;
      EXPECT_LT(cross(p[b] - p[a], p[c] - p[a]).z, 0);
    }
  }
}

TEST_F(Obj, FillsALargeStar) {
  // 200 points, every other one far inside: no fan fills it.
  std::string text, face = "f";
  double doubled_area = 0;
  std::vector<Vec2> outline;
  for (int i = 0; i < 200; ++i) {
    const float angle = 2 * 3.14159265f * float(i) / 200, radius = i % 2 == 0 ? 1.0f : 0.2f;
    outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    text += "v 7 " + std::to_string(outline.back().x) + " " + std::to_string(outline.back().y) + "\n";
    face += " " + std::to_string(i + 1);
  }
  for (int i = 0; i < 200; ++i) {
    const Vec2 a = outline[i], b = outline[(i + 1) % 200];
    doubled_area += double(a.x) * b.y - double(a.y) * b.x;
  }
  const SceneDesc desc = load(write("star.obj", text + face + "\n"));
  EXPECT_EQ(mesh_of(desc).indices.size(), 198u);
  EXPECT_NEAR(area_of(mesh_of(desc)), doubled_area / 2, 1e-4);
}

TEST_F(Obj, BeginsAGeometryWithEachGroupThatHasFaces) {
  const SceneDesc desc = load(write("a.obj",
                                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\no table\ng top left\nf 1 2 3\n"
                                    "g empty\ng legs\nf 2 4 3\nf 1 2 4\n"));
  ASSERT_EQ(desc.geometries.size(), 2u);
  EXPECT_EQ(desc.geometries[0].name, "top left");
  EXPECT_EQ(desc.geometries[1].name, "legs");
  EXPECT_EQ(mesh_of(desc, 0).positions.size(), 3u);
  EXPECT_EQ(mesh_of(desc, 1).positions.size(), 4u);
}

TEST_F(Obj, GivesMaterialsToFaces) {
  write("a.mtl",
        "newmtl red\nKd 0.5 0 0\nnewmtl lamp\nKd 0 0 0\nKe 4 5 6\nnewmtl gold\nPm 1\nPr 0.5\nKd 1 0.8 0.2\n"
        "newmtl window\nillum 4\nNi 1.3\nd 0.1\nKd 1 1 1\nnewmtl varnish\nillum 2\nKd 0 0 1\nKs 0.3 0.3 "
        "0.3\nNs 198\n"
        "newmtl mirror\nillum 3\nKd 0 0 0\nKs 0.9 0.9 0.9\n");
  const SceneDesc desc = load(write("a.obj",
                                    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nusemtl red\nf 1 2 3\n"
                                    "usemtl lamp\nf 1 2 3 4\ng b\nusemtl gold\nf 1 2 3\n"));
  EXPECT_TRUE(desc.warnings.empty());
  ASSERT_EQ(desc.geometries.size(), 2u);
  const auto named = [&](MaterialId id) { return id.is_valid() ? desc.materials.at(id.value).name : "none"; };
  ASSERT_EQ(desc.geometries[0].materials.size(), 3u);
  EXPECT_EQ(named(desc.geometries[0].materials[0]), "red");
  EXPECT_EQ(named(desc.geometries[0].materials[1]), "lamp");
  EXPECT_EQ(named(desc.geometries[0].materials[2]), "lamp");
  EXPECT_TRUE(desc.geometries[1].materials.empty());
  EXPECT_EQ(named(desc.geometries[1].material), "gold");

  ASSERT_EQ(desc.materials.size(), 6u);
  EXPECT_EQ(desc.materials[0].kind, Material::Kind::matte);
  EXPECT_EQ(desc.materials[0].color, (Vec3{0.5f, 0, 0}));
  EXPECT_EQ(desc.materials[1].emission, (Vec3{4, 5, 6}));
  EXPECT_EQ(desc.materials[2].kind, Material::Kind::metal);
  EXPECT_FLOAT_EQ(desc.materials[2].roughness, 0.25f);
  EXPECT_EQ(desc.materials[3].kind, Material::Kind::glass);
  EXPECT_FLOAT_EQ(desc.materials[3].ior, 1.3f);
  EXPECT_EQ(desc.materials[4].kind, Material::Kind::plastic);
  EXPECT_NEAR(desc.materials[4].roughness, 0.1f, 1e-6f);
  EXPECT_EQ(desc.materials[5].kind, Material::Kind::mirror);
}

TEST_F(Obj, GoesOnWithoutWhatIsMissingAndSaysSo) {
  write("a.mtl", "newmtl cloth\nKd 1 1 1\nmap_Kd nowhere.png\n");
  const SceneDesc desc =
      load(write("a.obj",
                 "mtllib a.mtl gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl cloth\nf 1 2 3\n"
                 "usemtl silk\nf 1 3 2\nl 1 2\nl 2 3\n"));
  ASSERT_EQ(desc.warnings.size(), 4u);
  EXPECT_CONTAINS(desc.warnings[0], "nowhere.png: no such file");
  EXPECT_CONTAINS(desc.warnings[1], "gone.mtl: no such file");
  EXPECT_CONTAINS(desc.warnings[2], "a.obj:line 7: material 'silk' is not known");
  EXPECT_CONTAINS(desc.warnings[3], "a.obj:line 9: 'l' is not used (2 of them)");
  EXPECT_EQ(defined_primitive_count(desc), 2u);
  EXPECT_FALSE(desc.materials.at(0).color_texture.is_valid());
}

TEST_F(Obj, SaysOnWhichLineAFileIsWrong) {
  const std::string start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const struct {
    std::string rest, expected;
  } cases[] = {
      {"f 1 2 4\n", "a.obj:line 4: a face has vertex 4, but there are 3 so far"},
      {"\nf 1 2 -4\n", "a.obj:line 5: a face has vertex -4, but there are 3 so far"},
      {"f 0 1 2\n", "line 4: a face has vertex 0"},
      {"f 1 2\n", "line 4: a face has 2 corners"},
      {"f 1/1 2/1 3/1\n", "line 4: a face has texture coordinate 1, but there are 0"},
      {"f 1//7 2//1 3//1\n", "line 4: a face has normal 7, but there are 0"},
      {"f 1 2 x\n", "line 4: a face has 'x'"},
      {"f 1 2 99999999999999999999\n", "line 4: a face has '99999999999999999999'"},
      {"v 1 2\n", "line 4: a vertex ends early"},
      {"v 1 2 three\n", "line 4: a vertex has 'three', expected a number"},
      {"v 1 nan 3\n", "line 4: vertex 4 has a coordinate that is not finite"},
      {"v 1 2 1e99\n", "line 4: vertex 4 has a coordinate that is not finite"},
      {"# no face\n", "there is no triangle"},
  };
  for (const auto& [rest, expected] : cases) {
    const auto file = write("a.obj", start + rest);
    EXPECT_CONTAINS(message_of<FileError>([&] { load(file); }), expected);
  }
}

TEST_F(Obj, TakesTinyNumbersAsZero) {
  const SceneDesc desc = load(write("a.obj", "v 1e-99 -1e-60 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  EXPECT_EQ(mesh_of(desc).positions[0], (Vec3{0, 0, 0}));
}

TEST_F(Obj, MendsNormalsThatAreNone) {
  const SceneDesc desc =
      load(write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn nan nan nan\nvn 0 0 -1\nf 1//1 2//2 3\n"));
  EXPECT_EQ(mesh_of(desc).normals, (std::vector<Vec3>{{0, 0, 1}, {0, 0, -1}, {0, 0, 1}}));
}

TEST_F(Obj, ReadsTheBunnyWhole) {
  BOXWOOD_NEEDS_MODELS();
  const SceneDesc desc = load(std::filesystem::path(models_folder()) / "bunny.obj");
  ASSERT_EQ(desc.geometries.size(), 1u);
  EXPECT_EQ(mesh_of(desc).indices.size(), 69451u);
  EXPECT_LE(mesh_of(desc).positions.size(), 35947u);
  EXPECT_TRUE(desc.warnings.empty());
}

}  // namespace
}  // namespace boxwood::io
