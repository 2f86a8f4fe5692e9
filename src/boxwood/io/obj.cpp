// obj.cpp: what is in this Wavefront OBJ file, and in the MTL files that it names?
//
// The geometry is read here rather than by tinyobjloader, whose reader (2.0rc10) turns coordinates that are
// no numbers into zeros, hands out indices that point nowhere, and cannot say on which line. Materials come
// from its LoadMtl.
//
// A corner of a face names a position, a texture coordinate and a normal apart; a vertex of ours is one such
// triple. Each `o` and `g` begins a geometry, in which equal triples are one vertex.

#include <array>
#include <map>
#include <sstream>

#include "boxwood/io/file_bytes.h"
#include "boxwood/io/formats.h"
#include "boxwood/io/mtl.h"
#include "boxwood/io/polygon.h"
#include "boxwood/io/text_scanner.h"
#include "boxwood/io/vertex_colors.h"

namespace boxwood::io {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

/// Positions in the file's lists; kNone where a corner names no texture coordinate or no normal.
struct Corner {
  std::uint32_t position, uv, normal;
  friend bool operator==(const Corner&, const Corner&) = default;
};

class ObjReader {
 public:
  ObjReader(const std::filesystem::path& path, std::string_view text)
      : path_(path), path_string_(path.string()), scanner_(text, path_string_) {}

  SceneDesc read() {
    do {
      read_line();
    } while (scanner_.next_line());
    finish_geometry();
    if (!colors_.empty()) show_vertex_colors(desc_);
    for (const auto& [keyword, place] : skipped_)
      desc_.warnings.push_back(path_string_ + ":line " + std::to_string(place.first_line) + ": " +
                               in_quotes(keyword) + " is not used (" + std::to_string(place.count) +
                               " of them)");
    return std::move(desc_);
  }

 private:
  void read_line() {
    const std::string_view keyword = scanner_.word_on_line();
    if (keyword.empty() || keyword[0] == '#') return;
    if (keyword == "v") {
      positions_.push_back(read_vector("a vertex"));
      if (!is_finite(positions_.back()))
        scanner_.fail("vertex " + std::to_string(positions_.size()) + " has a coordinate that is not finite");
      first_vertex_at_.push_back(kNone);
      read_color();
    } else if (keyword == "vn") {
      normals_.push_back(read_vector("a normal"));
    } else if (keyword == "vt") {
      const float u = read_number("a texture coordinate");
      const std::string_view v = scanner_.word_on_line();
      uvs_.push_back({u, v.empty() ? 0 : to_number(v, "a texture coordinate")});
    } else if (keyword == "f") {
      read_face();
    } else if (keyword == "o" || keyword == "g") {
      finish_geometry();
      name_ = scanner_.rest_of_line();
    } else if (keyword == "usemtl") {
      use_material(std::string(scanner_.rest_of_line()));
    } else if (keyword == "mtllib") {
      read_libraries(std::string(scanner_.rest_of_line()));
    } else if (keyword != "s") {  // Smoothing groups say nothing beyond the normals.
      skip(keyword);
    }
  }

  float to_number(std::string_view word, const char* what) {
    float value;
    if (!parse_float(word, value))
      scanner_.fail(std::string(what) + " has " + in_quotes(word) + ", expected a number");
    return value;
  }
  float read_number(const char* what) {
    const std::string_view word = scanner_.word_on_line();
    if (word.empty()) scanner_.fail(std::string(what) + " ends early, expected a number");
    return to_number(word, what);
  }
  Vec3 read_vector(const char* what) {
    const float x = read_number(what), y = read_number(what), z = read_number(what);
    return {x, y, z};
  }

  // Behind a position a weight may stand, which says nothing here, or a color, or both. Other vertices of the
  // file are white.
  void read_color() {
    std::array<float, 4> rest{};
    std::size_t count = 0;
    for (std::string_view word; count < 4 && !(word = scanner_.word_on_line()).empty(); ++count)
      if (!parse_float(word, rest[count])) break;
    if (count >= 3) {
      const float* color = &rest[count - 3];
      colors_.resize(positions_.size() - 1, {1, 1, 1, 1});
      colors_.push_back(vertex_color_of_srgb(color[0], color[1], color[2]));
    } else if (!colors_.empty()) {
      colors_.push_back({1, 1, 1, 1});
    }
  }

  // Counts from 1, or from -1 back from the newest.
  std::uint32_t read_index(std::string_view digits, std::size_t count, const char* what) {
    std::int64_t index;
    if (!parse_int(digits, index))
      scanner_.fail("a face has " + in_quotes(digits) + ", expected the number of " + what);
    const std::int64_t n = static_cast<std::int64_t>(count);
    if (index == 0 || index > n || index < -n)
      scanner_.fail("a face has " + std::string(what) + " " + std::to_string(index) + ", but there are " +
                    std::to_string(n) + " so far");
    return static_cast<std::uint32_t>(index > 0 ? index - 1 : n + index);
  }

  // One of: position, position/uv, position//normal, position/uv/normal.
  Corner read_corner(std::string_view word) {
    const std::size_t slash = word.find('/');
    Corner corner{read_index(word.substr(0, slash), positions_.size(), "vertex"), kNone, kNone};
    if (slash == std::string_view::npos) return corner;
    word.remove_prefix(slash + 1);
    const std::size_t second = word.find('/');
    if (const std::string_view uv = word.substr(0, second); !uv.empty())
      corner.uv = read_index(uv, uvs_.size(), "texture coordinate");
    if (second == std::string_view::npos) return corner;
    if (const std::string_view normal = word.substr(second + 1); !normal.empty())
      corner.normal = read_index(normal, normals_.size(), "normal");
    return corner;
  }

  void read_face() {
    face_.clear();
    for (std::string_view word; !(word = scanner_.word_on_line()).empty();) {
      if (word[0] == '#') break;
      face_.push_back(vertex_of(read_corner(word)));
    }
    if (face_.size() < 3)
      scanner_.fail("a face has " + std::to_string(face_.size()) + " corners, expected at least 3");
    triangulate(mesh_.positions, face_, mesh_.indices);
    materials_.resize(mesh_.indices.size(), material_);
  }

  // The vertex of the current geometry for this corner; a new one when no corner before was equal. The
  // vertices that share a position form a list.
  std::uint32_t vertex_of(const Corner& corner) {
    std::uint32_t& first = first_vertex_at_[corner.position];
    for (std::uint32_t vertex = first; vertex != kNone; vertex = next_vertex_[vertex])
      if (corners_[vertex] == corner) return vertex;
    const auto vertex = static_cast<std::uint32_t>(corners_.size());
    corners_.push_back(corner);
    next_vertex_.push_back(first);
    first = vertex;
    mesh_.positions.push_back(positions_[corner.position]);
    return vertex;
  }

  void finish_geometry() {
    if (mesh_.indices.empty()) return;

    // Gather normals and texture coordinates when any corner has one;
    // the others get a zero, which load() mends.
    bool has_normals = false, has_uvs = false;
    for (const Corner& corner : corners_) {
      has_normals |= corner.normal != kNone;
      has_uvs |= corner.uv != kNone;
    }
    for (const Corner& corner : corners_) {
      if (has_normals) mesh_.normals.push_back(corner.normal != kNone ? normals_[corner.normal] : Vec3{});
      if (has_uvs) mesh_.uvs.push_back(corner.uv != kNone ? uvs_[corner.uv] : Vec2{});
      if (!colors_.empty())
        mesh_.colors.push_back(corner.position < colors_.size() ? colors_[corner.position]
                                                                : std::array<float, 4>{1, 1, 1, 1});
      first_vertex_at_[corner.position] = kNone;
    }

    // One material for all triangles when they agree.
    Geometry geometry{std::move(mesh_), materials_.front(), {}, name_};
    for (const MaterialId id : materials_)
      if (id != geometry.material) {
        geometry.material = {};
        geometry.materials = std::move(materials_);
        break;
      }
    desc_.add(std::move(geometry));
    mesh_ = {};
    corners_.clear();
    next_vertex_.clear();
    materials_.clear();
  }

  void use_material(const std::string& name) {
    const auto [found, is_new] = material_ids_.try_emplace(name);
    if (is_new)
      desc_.warnings.push_back(path_string_ + ":line " + std::to_string(scanner_.line()) + ": material " +
                               in_quotes(name) + " is not known; the default takes its place");
    material_ = found->second;
  }

  // Names of libraries are parted by spaces, but programs also write one name that has spaces in it.
  void read_libraries(std::string names) {
    for (char& c : names)
      if (c == '\\') c = '/';
    std::vector<std::string> files;
    std::error_code error;
    if (std::filesystem::exists(path_.parent_path() / names, error)) {
      files.push_back(names);
    } else {
      std::istringstream words(names);
      for (std::string word; words >> word;) files.push_back(word);
    }
    for (const std::string& file : files) load_mtl(path_.parent_path() / file, desc_, material_ids_);
  }

  // What this reader has no use for (lines, points, curves, and noise) is reported once for each keyword.
  void skip(std::string_view keyword) {
    constexpr std::size_t kMostKeywords = 8;
    const auto found = skipped_.find(keyword);
    if (found != skipped_.end())
      ++found->second.count;
    else if (skipped_.size() < kMostKeywords)
      skipped_.emplace(keyword, Skipped{scanner_.line(), 1});
  }

  struct Skipped {
    std::size_t first_line, count;
  };

  const std::filesystem::path& path_;
  const std::string path_string_;
  TextScanner scanner_;
  SceneDesc desc_;
  std::map<std::string, MaterialId> material_ids_;
  std::map<std::string, Skipped, std::less<>> skipped_;

  // The file's lists, which all its geometries share.
  std::vector<Vec3> positions_, normals_;
  std::vector<Vec2> uvs_;
  std::vector<std::array<float, 4>> colors_;  // empty until a position has one

  // The geometry that is being read. For each of the file's positions the first vertex there, and from vertex
  // to vertex the next in the same place.
  std::string name_;
  TriangleMesh mesh_;
  std::vector<MaterialId> materials_;
  std::vector<Corner> corners_;
  std::vector<std::uint32_t> first_vertex_at_, next_vertex_;

  MaterialId material_;
  std::vector<std::uint32_t> face_;
};

}  // namespace

SceneDesc load_obj(const std::filesystem::path& path, Executor&) {
  const std::string text = read_file(path);
  return ObjReader(path, without_byte_order_mark(text)).read();
}

}  // namespace boxwood::io
