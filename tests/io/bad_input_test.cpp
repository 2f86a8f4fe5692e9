// Damaged files of every format, in thousands of repeatable ways; and paths that are no files.
#include "boxwood/io/image.h"
#include "io/mutations.h"

namespace boxwood::io {
namespace {

constexpr int kMutations = 3000;

const std::string kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1.5e0\n";

std::string ply_header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment a tetrahedron\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
         "z\n"
         "property uchar red\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
}

// The tetrahedron's PLY body in bytes of one order.
std::string ply_body(bool is_big) {
  std::string body;
  const auto put = [&](std::uint32_t bits) {
    for (int i = 0; i < 4; ++i) body += static_cast<char>(bits >> 8 * (is_big ? 3 - i : i));
  };
  for (int vertex = 0; vertex < 4; ++vertex) {
    for (int axis = 0; axis < 3; ++axis) put(vertex == axis + 1 ? 0x3f800000u : 0u);
    body += '\x7f';
  }
  for (const auto& face :
       {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{1, 2, 3}, std::array{2, 0, 3}}) {
    body += '\x03';
    for (const int corner : face) put(static_cast<std::uint32_t>(corner));
  }
  return body;
}

TEST_F(BadInput, Obj) {
  write("a.mtl", "newmtl red\nKd 1 0 0\n");
  expect_load_survives(
      "mtllib a.mtl\n# made by hand\no body\n" + kTetrahedron +
          "vt 0 0\nvt 1 1\nvn 0 0 1\nusemtl red\ns off\nf 1/1/1 3/2/1 2/1/1\nf 1//1 2//1 4//1\n"
          "g rest\nf 2 3 -1\nf -2 1 4 2 \\\n 3\nl 1 2\n",
      "a.obj", kMutations);
}

TEST_F(BadInput, Mtl) {
  const auto scene =
      write("a.obj", "mtllib a.mtl\n" + kTetrahedron + "usemtl red\nf 1 3 2\nusemtl b\nf 1 2 4\n");
  write_image(path("a.png"), Image(2, 2));
  const std::string good =
      "newmtl red\nKa 0 0 0\nKd 1 0 0\nKs 0.5 0.5 0.5\nKe 0 0 0\nNs 20\nNi 1.5\nd 0.9\nTf 1 1 1\nillum 2\n"
      "map_Kd -s 1 1 1 -o 0 0 0 -mm 0 1 -clamp on a.png\nmap_bump -bm 1 -imfchan r b.png\nnewmtl b\nPr "
      "0.5\nPm 1\n"
      "map_Kd a.png\nfoo bar\n";
  // No damage to a material is worth losing the scene: everything becomes a warning.
  for (int i = 0; i < kMutations; ++i) {
    Random random(static_cast<std::uint64_t>(i));
    write("a.mtl", mutate(good, random));
    const SceneDesc desc = load(scene);
    for (const std::string& warning : desc.warnings)
      EXPECT_EQ(warning.find_first_of("\n\r"), std::string::npos) << warning;
    for (const Material& material : desc.materials) {
      EXPECT_TRUE(is_finite(material.color) && is_finite(material.emission)) << i;
      EXPECT_TRUE(material.roughness >= 0 && material.roughness <= 1) << i;
      EXPECT_TRUE(std::isfinite(material.ior) && material.ior >= 1) << i;
    }
  }
}

TEST_F(BadInput, PlyAscii) {
  expect_load_survives(
      ply_header("ascii") + "0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 4\n3 0 2 1\n3 0 1 3\n3 1 2 3\n4 2 0 3 1\n",
      "a.ply", kMutations);
}
TEST_F(BadInput, PlyLittleEndian) {
  expect_load_survives(ply_header("binary_little_endian") + ply_body(false), "a.ply", kMutations);
}
TEST_F(BadInput, PlyBigEndian) {
  expect_load_survives(ply_header("binary_big_endian") + ply_body(true), "a.ply", kMutations);
}

TEST_F(BadInput, StlText) {
  const std::string facet =
      " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0.5\n  endloop\n "
      "endfacet\n";
  expect_load_survives("solid part\n" + facet + facet + "endsolid part\n", "a.stl", kMutations);
}
TEST_F(BadInput, StlBytes) {
  std::string stl = "solid, but in bytes";
  stl.resize(80);
  stl += std::string("\x02\0\0\0", 4);
  for (int triangle = 0; triangle < 2; ++triangle) {
    for (int i = 0; i < 12; ++i)
      stl += std::string("\0\0", 2) + (i % 4 == triangle ? "\x80\x3f" : "\x40\x40");
    stl += std::string("\0\0", 2);
  }
  expect_load_survives(stl, "a.stl", kMutations);
}

class BadPicture : public BadInput {
 protected:
  void expect_picture_survives(const std::string& good, const std::string& target) const {
    expect_survives(good, target, 1000, [](const std::filesystem::path& file) {
      const Texture texture = read_texture(file);
      EXPECT_EQ(texture.texels.size(), std::size_t(texture.width) * texture.height);
    });
  }
  void expect_written_picture_survives(const std::string& extension) const {
    Image image(17, 9, 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i % 7) / 6;
    write_image(path("good" + extension), image);
    expect_picture_survives(read(path("good" + extension)), "a" + extension);
  }
};

TEST_F(BadPicture, Png) {
  expect_written_picture_survives(".png");
}
TEST_F(BadPicture, Exr) {
  expect_written_picture_survives(".exr");
}
TEST_F(BadPicture, Hdr) {
  expect_written_picture_survives(".hdr");
}

TEST_F(BadInput, PathsThatAreNoFiles) {
  for (const char* extension : {".obj", ".ply", ".stl"}) {
    const std::string name = std::string("a") + extension;
    EXPECT_EQ(message_of<FileError>([&] { load(path(name)); }), path(name).string() + ": no such file");
    write(name, "");
    EXPECT_EQ(message_of<FileError>([&] { load(path(name)); }), path(name).string() + ": the file is empty");
    std::filesystem::remove(path(name));
    std::filesystem::create_directory(path(name));
    EXPECT_EQ(message_of<FileError>([&] { load(path(name)); }),
              path(name).string() + ": is a folder, expected a file");
  }
}

}  // namespace
}  // namespace boxwood::io
