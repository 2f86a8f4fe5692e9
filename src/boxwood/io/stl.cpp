// stl.cpp: what triangles are in this stereolithography file?
//
// 3D Systems' format (1987) lists each triangle with corners of its own, as text or as 50 bytes after a
// header of 84. Corners in exactly the same place become one vertex here, so that what was closed in the file
// is closed in memory. The file's facet normals are not used: the order of the corners says the same.

#include <array>
#include <bit>
#include <cstring>
#include <unordered_map>

#include "boxwood/io/file_bytes.h"
#include "boxwood/io/formats.h"
#include "boxwood/io/text_scanner.h"

namespace boxwood::io {
namespace {

constexpr std::size_t kHeaderBytes = 84, kTriangleBytes = 50;

/// Collects triangles whose corners are points.
class Welder {
 public:
  void add(const std::array<Vec3, 3>& corners) {
    mesh_.indices.push_back({vertex_at(corners[0]), vertex_at(corners[1]), vertex_at(corners[2])});
  }
  bool is_empty() const { return mesh_.indices.empty(); }
  TriangleMesh take() {
    ids_.clear();
    return std::exchange(mesh_, {});
  }

 private:
  using Bits = std::array<std::uint32_t, 3>;
  struct Hash {
    std::size_t operator()(const Bits& b) const {
      std::uint64_t h = 0;
      for (const std::uint32_t word : b) h = (h ^ word) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
      return h;
    }
  };

  std::uint32_t vertex_at(Vec3 p) {
    p += Vec3{0, 0, 0};  // -0 and +0 are the same place.
    const Bits bits{std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                    std::bit_cast<std::uint32_t>(p.z)};
    const auto [found, is_new] = ids_.try_emplace(bits, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new) mesh_.positions.push_back(p);
    return found->second;
  }

  TriangleMesh mesh_;
  std::unordered_map<Bits, std::uint32_t, Hash> ids_;
};

float read_float(const char* bytes) {
  std::uint32_t bits = 0;
  for (int i = 3; i >= 0; --i) bits = bits << 8 | static_cast<unsigned char>(bytes[i]);
  return std::bit_cast<float>(bits);
}

std::uint64_t read_count(std::string_view bytes) {
  std::uint32_t count = 0;
  for (std::size_t i = kHeaderBytes; i-- > kHeaderBytes - 4;)
    count = count << 8 | static_cast<unsigned char>(bytes[i]);
  return count;
}

// Text begins with "solid", but so do the free header bytes of many binary files. The size decides where it
// fits a binary file to the byte; otherwise text must also have its second keyword.
bool is_text(std::string_view bytes) {
  if (!bytes.starts_with("solid")) return false;
  if (bytes.size() >= kHeaderBytes && bytes.size() == kHeaderBytes + kTriangleBytes * read_count(bytes))
    return false;
  return bytes.find("facet") != std::string_view::npos || bytes.find("endsolid") != std::string_view::npos;
}

SceneDesc read_binary(std::string_view bytes, const std::string& path) {
  if (bytes.size() < kHeaderBytes)
    throw FileError(path, "byte " + std::to_string(bytes.size()),
                    "the file ends within the header of 84 bytes");
  const std::uint64_t count = read_count(bytes), room = (bytes.size() - kHeaderBytes) / kTriangleBytes;
  if (count > room)
    throw FileError(path, "byte 80",
                    "the header tells of " + std::to_string(count) +
                        " triangles, but the file has bytes for " + std::to_string(room));

  Welder welder;
  for (std::uint64_t t = 0; t < count; ++t) {
    const char* at = bytes.data() + kHeaderBytes + t * kTriangleBytes + 12;  // Past the facet normal.
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners)
      for (int axis = 0; axis < 3; ++axis, at += 4) corner[axis] = read_float(at);
    welder.add(corners);
  }
  SceneDesc desc;
  desc.add(welder.take());
  return desc;
}

// Every `solid` of the file becomes a geometry.
SceneDesc read_text(std::string_view bytes, const std::string& path) {
  TextScanner scanner(bytes, path);
  SceneDesc desc;
  Welder welder;
  std::string name;
  const auto finish = [&] {
    if (!welder.is_empty()) desc.add(Geometry{welder.take(), {}, {}, name});
  };
  std::array<Vec3, 3> corners;
  std::size_t known = 0;  // How many corners of the current facet have been read.
  bool is_open = false;   // Whether an `endsolid` is still to come.
  for (;;) {
    const std::string_view keyword = scanner.word();
    if (keyword.empty()) break;
    if (keyword == "solid") {
      finish();
      name = scanner.rest_of_line();
      is_open = true;
    } else if (keyword == "vertex") {
      if (known == 3) scanner.fail("a facet has more than 3 vertices");
      for (int axis = 0; axis < 3; ++axis) {
        const std::string_view word = scanner.word();
        if (!parse_float(word, corners[known][axis]) || !std::isfinite(corners[known][axis]))
          scanner.fail("a vertex has " + in_quotes(word) + ", expected a finite number");
      }
      ++known;
    } else if (keyword == "endfacet") {
      if (known != 3) scanner.fail("a facet has " + std::to_string(known) + " vertices, expected 3");
      welder.add(corners);
      known = 0;
    } else if (keyword == "facet" || keyword == "endsolid") {
      if (known != 0) scanner.fail(in_quotes(keyword) + " comes before the 'endfacet' of the facet before");
      scanner.rest_of_line();
      if (keyword == "endsolid") is_open = false;
    } else if (keyword != "outer" && keyword != "loop" && keyword != "endloop") {
      scanner.fail(in_quotes(keyword) + " is not a word of this format");
    }
  }
  if (is_open) scanner.fail("the file ends before its 'endsolid'");
  finish();
  return desc;
}

}  // namespace

SceneDesc load_stl(const std::filesystem::path& path, Executor&) {
  const std::string name = path.string(), bytes = read_file(path);
  const std::string_view text = without_byte_order_mark(bytes);
  return is_text(text) ? read_text(text, name) : read_binary(bytes, name);
}

}  // namespace boxwood::io
