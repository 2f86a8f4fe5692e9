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
    testing::internal::CaptureStderr();
    expect_survives(good, target, 1000, [](const std::filesystem::path& file) {
      const Texture texture = read_texture(file);
      EXPECT_EQ(texture.texels.size(), std::size_t(texture.width) * texture.height);
    });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "a codec prints";
  }
  void expect_written_picture_survives(const std::string& extension) const {
    Image image(17, 9, 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i % 7) / 6;
    write_image(path("good" + extension), image);
    expect_picture_survives(read(path("good" + extension)), "a" + extension);
  }
};

// 9 x 7 grey pixels of noise.
constexpr std::string_view kJpegInHex =
    "ffd8ffe000104a46494600010100000100010000ffdb004300140e0f120f0d14121012171514181e32211e1c1c1e3d2c"
    "2e243249404c4b47404645505a736250556d5645466488656d777b8182814e608d978c7d96737e817cffc0000b080007"
    "000901011100ffc4001f0000010501010101010100000000000000000102030405060708090a0bffc400b51000020103"
    "03020403050504040000017d01020300041105122131410613516107227114328191a1082342b1c11552d1f024336272"
    "82090a161718191a25262728292a3435363738393a434445464748494a535455565758595a636465666768696a737475"
    "767778797a838485868788898a92939495969798999aa2a3a4a5a6a7a8a9aab2b3b4b5b6b7b8b9bac2c3c4c5c6c7c8c9"
    "cad2d3d4d5d6d7d8d9dae1e2e3e4e5e6e7e8e9eaf1f2f3f4f5f6f7f8f9faffda0008010100003f0044fde39cb876ef8e"
    "bdb06a4f35ff00e79a7e47fc6bffd9";

std::string from_hex(std::string_view hex) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(digit(hex[i]) << 4 | digit(hex[i + 1]));
  return bytes;
}

TEST_F(BadPicture, Jpeg) {
  expect_picture_survives(from_hex(kJpegInHex), "a.jpg");
}

TEST_F(BadPicture, Tga) {
  // 3 x 2 pixels with run lengths, as most painters write them.
  std::string tga(18, '\0');
  tga[2] = 10;
  tga[12] = 3;
  tga[14] = 2;
  tga[16] = 24;
  expect_picture_survives(tga + "\x82" + "abc" + "\x02" + "abcdefghi", "a.tga");
}

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
