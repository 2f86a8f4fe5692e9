// What a PLY file becomes, in each of its three encodings.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "boxwood/io/formats.h"
#include "boxwood/io/load.h"
#include "io/files.h"

namespace boxwood::io {
namespace {

using Ply = Files;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Appends numbers as a PLY body of one encoding.
class Body {
 public:
  enum class Encoding { ascii, little, big };
  explicit Body(Encoding encoding) : encoding_(encoding) {}

  template <class T>
  Body& put(T value) {
    if (encoding_ == Encoding::ascii) {
      text_ += std::to_string(value) + "\n";
      return *this;
    }
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if ((encoding_ == Encoding::big) != (std::endian::native == std::endian::big))
      std::reverse(bytes, bytes + sizeof(T));
    text_.append(bytes, sizeof(T));
    return *this;
  }
  std::string format() const {
    constexpr const char* kNames[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    return std::string("ply\nformat ") + kNames[static_cast<int>(encoding_)] + " 1.0\n";
  }
  const std::string& text() const { return text_; }

 private:
  Encoding encoding_;
  std::string text_;
};

constexpr Body::Encoding kEncodings[] = {Body::Encoding::ascii, Body::Encoding::little, Body::Encoding::big};

TEST_F(Ply, ReadsEveryEncodingAndSkipsWhatItDoesNotKnow) {
  for (const Body::Encoding encoding : kEncodings) {
    Body body(encoding);
    body.put(std::int16_t(-7)).put(std::uint8_t(2)).put(1.5).put(2.5);  // A camera.
    for (int i = 0; i < 4; ++i) {
      const float x = i == 1 || i == 2, y = i >= 2;
      body.put(std::uint8_t(200)).put(x).put(double(y)).put(0.5f);
      body.put(std::uint16_t(3)).put(std::int8_t(1)).put(std::int8_t(2)).put(std::int8_t(3));
      body.put(0.0f).put(0.0f).put(1.0f).put(x).put(y);
    }
    body.put(std::uint8_t(4)).put(0).put(1).put(2).put(3).put(std::uint32_t(9));
    body.put(std::uint8_t(3)).put(2).put(1).put(0).put(std::uint32_t(9));
    const std::string header =
        body.format() +
        "comment made by hand\nobj_info none\nelement camera 1\nproperty short shutter\n"
        "property list uchar double lens\nelement vertex 4\nproperty uchar red\n"
        "property float x\nproperty double y\nproperty float32 z\n"
        "property list ushort char tags\nproperty float nx\nproperty float ny\n"
        "property float nz\nproperty float s\nproperty float t\nelement face 2\n"
        "property list uint8 int32 vertex_index\nproperty uint flags\nend_header\n";
    const TriangleMesh mesh = read_ply_mesh(write("a.ply", header + body.text()));
    EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0.5f}, {1, 0, 0.5f}, {1, 1, 0.5f}, {0, 1, 0.5f}}));
    EXPECT_EQ(mesh.normals, std::vector<Vec3>(4, {0, 0, 1}));
    EXPECT_EQ(mesh.uvs, (std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
    EXPECT_EQ(mesh.indices, (Triangles{{0, 1, 2}, {0, 2, 3}, {2, 1, 0}}));
  }
}

TEST_F(Ply, ReadsIndicesOfEveryType) {
  const auto check_type = [this](auto zero, const char* type, Body::Encoding encoding) {
    using T = decltype(zero);
    Body body(encoding);
    for (const float x : {0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f}) body.put(x);
    body.put(T(3)).put(T(2)).put(T(0)).put(T(1));
    const std::string header = body.format() +
                               "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                               "element face 1\nproperty list " +
                               type + " " + type + " vertex_indices\nend_header\n";
    EXPECT_EQ(read_ply_mesh(write("a.ply", header + body.text())).indices, (Triangles{{2, 0, 1}})) << type;
  };
  for (const Body::Encoding encoding : kEncodings) {
    check_type(std::int8_t(), "char", encoding);
    check_type(std::uint8_t(), "uint8", encoding);
    check_type(std::int16_t(), "int16", encoding);
    check_type(std::uint16_t(), "ushort", encoding);
    check_type(std::int32_t(), "int", encoding);
    check_type(std::uint32_t(), "uint", encoding);
  }
}

TEST_F(Ply, ReadsFacesThatComeBeforeTheirVertices) {
  const TriangleMesh mesh = read_ply_mesh(write("a.ply",
                                                "ply\r\nformat ascii 1.0\r\nelement face 1\r\nproperty list "
                                                "uchar int vertex_indices\r\nelement vertex 3\r\n"
                                                "property float x\r\nproperty float y\r\nproperty float "
                                                "z\r\nend_header\r\n3 0 1 2\r\n0 0 0\r\n1 0 0\r\n0 1 0"));
  EXPECT_EQ(mesh.indices, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(mesh.positions[2], (Vec3{0, 1, 0}));
}

TEST_F(Ply, TurnsEverySecondTriangleOfAStrip) {
  const TriangleMesh mesh = read_ply_mesh(
      write("a.ply",
            "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
            "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 -1 2 3 4 -1\n"));
  EXPECT_EQ(mesh.indices, (Triangles{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
}

TEST_F(Ply, VerticesHaveColors) {
  const auto scene = [&](const std::string& type, const std::string& colors) {
    std::string header = "ply\nformat ascii 1.0\nelement vertex 3\n";
    for (const std::string name : {"float x", "float y", "float z"}) header += "property " + name + "\n";
    for (const std::string name : {"red", "green", "blue"}) header += "property " + type + " " + name + "\n";
    return load(
        write("a.ply", header + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                           "0 0 0 " + colors + "\n1 0 0 " + colors + "\n0 1 0 " + colors + "\n3 0 1 2\n"));
  };
  const SceneDesc desc = scene("uchar", "255 188 0");
  const TriangleMesh& mesh = std::get<TriangleMesh>(desc.geometries.at(0).shapes);
  ASSERT_EQ(mesh.colors.size(), 3u);
  EXPECT_EQ(mesh.colors[0][0], 1);
  EXPECT_NEAR(mesh.colors[2][1], 0.5f, 0.005f);  // codes are sRGB
  EXPECT_EQ(mesh.colors[2][2], 0);
  EXPECT_EQ(mesh.colors[0][3], 1);
  const Material& material = desc.materials.at(desc.geometries[0].material.value);
  EXPECT_EQ(material.color, (Vec3{1, 1, 1}));
  EXPECT_EQ(desc.textures.at(material.color_texture.value).kind, Texture::Kind::vertex_color);

  const SceneDesc floats = scene("float", "1 .7353569 nan");
  const auto& color = std::get<TriangleMesh>(floats.geometries.at(0).shapes).colors.at(1);
  EXPECT_EQ(color[0], 1);
  EXPECT_NEAR(color[1], 0.5f, 1e-3f);
  EXPECT_EQ(color[2], 0);
}

TEST_F(Ply, SaysWhereAFileIsWrong) {
  const std::string vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string ascii = "ply\nformat ascii 1.0\n", points = "0 0 0\n1 0 0\n0 1 0\n";
  const struct {
    std::string text, expected;
  } cases[] = {
      {"plx\n", "a.ply:line 1: does not begin with 'ply'"},
      {"ply\nformat ascii 1.0\n", "has no 'end_header'"},
      {"ply\nelement vertex 0\nend_header\n", "has no 'format'"},
      {"ply\nformat morse 1.0\nend_header\n", "line 2: format 'morse'"},
      {ascii + "element vertex many\nend_header\n", "line 3: element 'vertex' has count 'many'"},
      {ascii + "element vertex -3\nend_header\n", "line 3: element 'vertex' has count '-3'"},
      {ascii + "element vertex 99999999999999999999\nend_header\n", "has count '99999999999999999999'"},
      {ascii + "property float x\nend_header\n", "line 3: a property comes before any element"},
      {ascii + "element vertex 1\nproperty quaternion x\nend_header\n",
       "line 4: a property has type 'quaternion'"},
      {ascii + "element vertex 1\nproperty list float int x\nend_header\n", "line 4: the length of a list"},
      {ascii + "elephant vertex 1\nend_header\n", "line 3: 'elephant' does not belong in the header"},
      {ascii + "element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
       "vertices have no x, y and z"},
      {ascii + vertices + "element face 1\nproperty int flags\nend_header\n" + points + "3\n",
       "no list vertex_indices"},
      {ascii + vertices + faces + "end_header\n" + points + "3 0 1 3\n",
       "a.ply:face 0: has index 3, but there are 3"},
      {ascii + vertices + faces + "end_header\n" + points + "3 0 1 -1\n", "face 0: has index -1"},
      {ascii + vertices + faces + "end_header\n" + points + "3 0 1 0.5\n", "face 0: has index 0.5"},
      {ascii + vertices + faces + "end_header\n" + points + "nan 0 1 2\n", "face 0 has a list of nan values"},
      {ascii + vertices + faces + "end_header\n" + points + "1e30 0 1 2\n", "face 0 has a list of"},
      {ascii + vertices + faces + "end_header\n" + points + "-3 0 1 2\n", "face 0 has a list of -3 values"},
      {ascii + vertices + faces + "end_header\n" + points + "3 0 1\n",
       "a.ply:line 13: the file ends too early"},
      {ascii + vertices + faces + "end_header\n0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", "line 11: has 'zero'"},
      {ascii + vertices + faces + "end_header\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n",
       "geometry 0, vertex 1 is (1.000000, nan"},
      {ascii + vertices + faces + "end_header\n0 0 0\n1 0 0\n0 -1e60 0\n3 0 1 2\n",
       "geometry 0, vertex 2 is"},
      {ascii + vertices + "end_header\n" + points, "a.ply: there is no triangle in it"},
      {ascii + vertices + faces + "end_header\n" + points + "2 0 1\n", "a.ply: there is no triangle in it"},
  };
  for (const auto& [text, expected] : cases) {
    const auto file = write("a.ply", text);
    EXPECT_CONTAINS(message_of<FileError>([&] { load(file); }), expected);
  }
}

TEST_F(Ply, BelievesNoCountThatTheFileHasNoBytesFor) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
    for (const char* count : {"1000000000000", "9223372036854775807", "4294967295"})
      for (const char* element : {"vertex", "face", "junk"}) {
        const auto file =
            write("a.ply", std::string("ply\nformat ") + format + " 1.0\nelement " + element + " " + count +
                               (element == std::string("face")
                                    ? "\nproperty list uchar int vertex_indices\n"
                                    : "\nproperty float x\nproperty float y\nproperty float z\n") +
                               "end_header\n0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n");
        EXPECT_CONTAINS(message_of<FileError>([&] { load(file); }), std::string("has count ") + count);
      }
  // An element without properties takes no bytes, however many there are.
  const auto file = write("a.ply", "ply\nformat ascii 1.0\nelement nothing 1000000000000\nend_header\n");
  EXPECT_CONTAINS(message_of<FileError>([&] { load(file); }), "no triangle");
}

TEST_F(Ply, SaysAtWhichByteALongListIsWrong) {
  Body body(Body::Encoding::little);
  for (int i = 0; i < 9; ++i) body.put(float(i));
  body.put(std::uint32_t(4000000000u)).put(0).put(1).put(2);
  const std::string header = body.format() +
                             "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                             "element face 1\nproperty list uint int vertex_indices\nend_header\n";
  const auto file = write("a.ply", header + body.text());
  EXPECT_CONTAINS(
      message_of<FileError>([&] { load(file); }),
      "a.ply:byte " + std::to_string(header.size() + 40) + ": face 0 has a list of 4000000000 values");
}

TEST_F(Ply, ReadsTheDragonWhole) {
  BOXWOOD_NEEDS_MODELS();
  const TriangleMesh mesh = read_ply_mesh(std::filesystem::path(models_folder()) / "dragon.ply");
  EXPECT_EQ(mesh.indices.size(), 202520u);
  EXPECT_EQ(mesh.positions.size(), 100250u);
}

TEST_F(Ply, ReadsEveryMeshOfTheKitchen) {
  BOXWOOD_NEEDS_MODELS();
  std::size_t files = 0, triangles = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(models_folder()) / "kitchen" / "models")) {
    const TriangleMesh mesh = read_ply_mesh(entry.path());
    const bool has_normals = read(entry.path()).find("property float nx") != std::string::npos;
    EXPECT_EQ(mesh.normals.size(), has_normals ? mesh.positions.size() : 0) << entry.path();
    EXPECT_EQ(mesh.uvs.size(), mesh.positions.size()) << entry.path();
    ++files;
    triangles += mesh.indices.size();
  }
  EXPECT_EQ(files, 295u);
  EXPECT_EQ(triangles, 1443509u) << "the scene file itself holds another 8";
}

}  // namespace
}  // namespace boxwood::io
