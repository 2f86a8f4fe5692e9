// ply.cpp: what mesh is in this PLY file?
//
// Greg Turk's polygon format (Stanford, 1994): a text header lists elements, each with a count and typed
// properties; their values follow as text or as bytes of either order. Everything that is not a vertex's
// position, normal, color or texture coordinate, nor the corners of a face or a triangle strip, is read over.
// A count is believed only as far as the file has bytes for it, so that no header can ask for memory that the
// file does not pay for.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "boxwood/io/file_bytes.h"
#include "boxwood/io/formats.h"
#include "boxwood/io/ply_header.h"
#include "boxwood/io/polygon.h"
#include "boxwood/io/text_scanner.h"
#include "boxwood/io/vertex_colors.h"

namespace boxwood::io {
namespace {

using ply::Element, ply::Encoding, ply::Header, ply::Property, ply::Type;

/// Hands out the values of a text body one by one. Every value takes at least a digit and a blank.
class TextBody {
 public:
  TextBody(std::string_view bytes, const Header& header, const std::string& path)
      : bytes_(bytes), scanner_(bytes, path) {
    for (std::size_t line = 1; line < header.lines; ++line) scanner_.next_line();
  }
  double next(Type) {
    const std::string_view word = scanner_.word();
    if (word.empty()) scanner_.fail("the file ends too early");
    float value;
    std::int64_t whole;  // Indices need more digits than a float has.
    if (parse_int(word, whole)) return static_cast<double>(whole);
    if (!parse_float(word, value)) scanner_.fail("has " + in_quotes(word) + ", expected a number");
    return value;
  }
  void skip(Type, std::uint64_t count) {
    while (count-- > 0)
      if (scanner_.word().empty()) scanner_.fail("the file ends too early");
  }
  /// How many values of this type can follow at most.
  std::uint64_t room(std::size_t) const { return (bytes_.size() - scanner_.offset() + 1) / 2; }
  [[noreturn]] void fail(const std::string& message) const { scanner_.fail(message); }

 private:
  std::string_view bytes_;
  TextScanner scanner_;
};

/// The same for bytes.
template <bool kSwap>
class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, const Header& header, const std::string& path)
      : bytes_(bytes), path_(path), at_(header.size_bytes) {}
  double next(Type type) {
    const std::size_t size = ply::size_of(type);
    if (size > bytes_.size() - at_) fail("the file ends too early");
    char value[8];
    for (std::size_t i = 0; i < size; ++i) value[kSwap ? size - 1 - i : i] = bytes_[at_ + i];
    at_ += size;
    switch (type) {
      case Type::int8:
        return as<std::int8_t>(value);
      case Type::uint8:
        return as<std::uint8_t>(value);
      case Type::int16:
        return as<std::int16_t>(value);
      case Type::uint16:
        return as<std::uint16_t>(value);
      case Type::int32:
        return as<std::int32_t>(value);
      case Type::uint32:
        return as<std::uint32_t>(value);
      case Type::float32:
        return as<float>(value);
      case Type::float64:
        return as<double>(value);
    }
    return 0;
  }
  void skip(Type type, std::uint64_t count) {
    if (count > room(ply::size_of(type))) fail("the file ends too early");
    at_ += count * ply::size_of(type);
  }
  std::uint64_t room(std::size_t size) const { return (bytes_.size() - at_) / size; }
  [[noreturn]] void fail(const std::string& message) const {
    throw FileError(path_, "byte " + std::to_string(at_), message);
  }

 private:
  template <class T>
  static T as(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  std::string_view bytes_;
  const std::string& path_;
  std::size_t at_;
};

/// Reads the elements in the file's order; faces wait as corners until every vertex is known.
template <class Body>
class MeshReader {
 public:
  MeshReader(const Body& body, const std::string& path) : body_(body), path_(path) {}

  TriangleMesh read(const Header& header) {
    for (const Element& element : header.elements) {
      if (element.properties.empty()) continue;
      check_count(element);
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face")
        read_corners(element, {"vertex_indices", "vertex_index"}, false);
      else if (element.name == "tristrips")
        read_corners(element, {"vertex_indices", "vertex_index"}, true);
      else
        for (std::uint64_t i = 0; i < element.count; ++i)
          for (const Property& property : element.properties) skip(property, element, i);
    }
    return join();
  }

 private:
  // Compare the count with the fewest bytes, or words, that so many elements take.
  void check_count(const Element& element) const {
    std::size_t bytes = 0;
    for (const Property& property : element.properties)
      bytes += ply::size_of(property.count_type.value_or(property.type));
    const std::size_t unit = std::is_same_v<Body, TextBody> ? 1 : bytes;
    const std::size_t per_element = std::is_same_v<Body, TextBody> ? element.properties.size() : 1;
    if (element.count > body_.room(unit) / per_element)
      body_.fail("element " + in_quotes(element.name) + " has count " + std::to_string(element.count) +
                 ", for which the file is too short");
  }

  std::uint64_t list_length(const Property& property, const Element& element, std::uint64_t i) {
    const double length = body_.next(*property.count_type);
    const bool is_possible =
        length >= 0 && length <= static_cast<double>(body_.room(ply::size_of(property.type)));
    if (!is_possible || length != std::floor(length))
      body_.fail(element.name + " " + std::to_string(i) + " has a list of " + show(length) +
                 " values, expected a whole number for which the file is long enough");
    return static_cast<std::uint64_t>(length);
  }

  void skip(const Property& property, const Element& element, std::uint64_t i) {
    body_.skip(property.type, property.count_type ? list_length(property, element, i) : 1);
  }

  void read_vertices(const Element& element) {
    if (element.count >= std::numeric_limits<std::uint32_t>::max())
      body_.fail("there are " + std::to_string(element.count) + " vertices, expected fewer than 2^32 - 1");

    // Say for each property which of our numbers it is, or that it is none.
    enum { x, y, z, nx, ny, nz, u, v, red, green, blue, kSlots };
    constexpr int kNowhere = kSlots;
    std::vector<int> slots(element.properties.size(), kNowhere);
    const auto place = [&](int slot, std::initializer_list<const char*> names) {
      const std::optional<std::size_t> found = element.find(names);
      if (found && !element.properties[*found].count_type) slots[*found] = slot;
      return slots.end() != std::find(slots.begin(), slots.end(), slot);
    };
    const bool has_x = place(x, {"x"}), has_y = place(y, {"y"}), has_z = place(z, {"z"});
    if (!has_x || !has_y || !has_z) body_.fail("vertices have no x, y and z");
    const bool has_nx = place(nx, {"nx"}), has_ny = place(ny, {"ny"}), has_nz = place(nz, {"nz"});
    const bool has_u = place(u, {"u", "s", "texture_u", "texture_s"}),
               has_v = place(v, {"v", "t", "texture_v", "texture_t"});
    const bool has_red = place(red, {"red", "r", "diffuse_red"}),
               has_green = place(green, {"green", "g", "diffuse_green"}),
               has_blue = place(blue, {"blue", "b", "diffuse_blue"});
    const bool has_colors = has_red && has_green && has_blue;
    std::array<float, kSlots + 1> units;
    units.fill(1);
    for (std::size_t p = 0; p < slots.size(); ++p)
      if (slots[p] >= red && slots[p] <= blue) units[slots[p]] = color_unit(element.properties[p].type);
    const bool has_normals = has_nx && has_ny && has_nz, has_uvs = has_u && has_v;

    mesh_.positions.reserve(element.count);
    if (has_normals) mesh_.normals.reserve(element.count);
    if (has_uvs) mesh_.uvs.reserve(element.count);
    if (has_colors) mesh_.colors.reserve(element.count);
    std::array<float, kSlots + 1> values{};
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (std::size_t p = 0; p < slots.size(); ++p) {
        const Property& property = element.properties[p];
        if (slots[p] == kNowhere)
          skip(property, element, i);
        else
          values[slots[p]] = to_float(body_.next(property.type));
      }
      mesh_.positions.push_back({values[x], values[y], values[z]});
      if (has_normals) mesh_.normals.push_back({values[nx], values[ny], values[nz]});
      if (has_uvs) mesh_.uvs.push_back({values[u], values[v]});
      if (has_colors)
        mesh_.colors.push_back(vertex_color_of_srgb(values[red] / units[red], values[green] / units[green],
                                                    values[blue] / units[blue]));
    }
  }

  /// The number that stands for full light.
  static float color_unit(Type type) {
    if (type == Type::float32 || type == Type::float64) return 1;
    return ply::size_of(type) == 1 ? 255 : 65535;
  }

  // A double that no float can hold becomes infinite, which load() reports with the vertex.
  static float to_float(double value) {
    constexpr double kMost = std::numeric_limits<float>::max();
    if (value > kMost) return std::numeric_limits<float>::infinity();
    if (value < -kMost) return -std::numeric_limits<float>::infinity();
    return static_cast<float>(value);
  }

  void read_corners(const Element& element, std::initializer_list<const char*> names, bool are_strips) {
    const std::optional<std::size_t> list = element.find(names);
    if (!list || !element.properties[*list].count_type)
      body_.fail("element " + in_quotes(element.name) + " has no list vertex_indices");
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        if (p != *list) {
          skip(property, element, i);
          continue;
        }
        const std::uint64_t length = list_length(property, element, i);
        for (std::uint64_t c = 0; c < length; ++c) corners_.push_back(body_.next(property.type));
        faces_.push_back({corners_.size(), i, are_strips});
      }
  }

  // Turn the corners into triangles, now that the vertices are known.
  TriangleMesh join() {
    std::vector<std::uint32_t> polygon;
    std::size_t begin = 0;
    mesh_.indices.reserve(faces_.size());
    for (const Face& face : faces_) {
      polygon.clear();
      bool is_turned = false;
      for (std::size_t c = begin; c < face.end; ++c) {
        // A strip begins anew after -1; every second triangle of a strip is turned the other way.
        if (face.is_strip && corners_[c] == -1) {
          polygon.clear();
          is_turned = false;
          continue;
        }
        polygon.push_back(to_vertex(corners_[c], face));
        if (face.is_strip && polygon.size() >= 3) {
          const std::uint32_t* last = &polygon[polygon.size() - 3];
          if (is_turned)
            mesh_.indices.push_back({last[1], last[0], last[2]});
          else
            mesh_.indices.push_back({last[0], last[1], last[2]});
          is_turned = !is_turned;
        }
      }
      if (!face.is_strip) triangulate(mesh_.positions, polygon, mesh_.indices);
      begin = face.end;
    }
    return std::move(mesh_);
  }

  struct Face {
    std::size_t end;  ///< One past its last corner; the first follows the last of the face before.
    std::uint64_t number;
    bool is_strip;
  };

  std::uint32_t to_vertex(double corner, const Face& face) const {
    const auto vertex = corner >= 0 && corner < 0x1p32 ? static_cast<std::uint32_t>(corner) : 0;
    if (vertex != corner || vertex >= mesh_.positions.size())
      throw FileError(path_, (face.is_strip ? "strip " : "face ") + std::to_string(face.number),
                      "has index " + show(corner) + ", but there are " +
                          std::to_string(mesh_.positions.size()) + " vertices");
    return vertex;
  }

  static std::string show(double number) {
    std::string text = std::to_string(number);
    if (const std::size_t dot = text.find(".000000"); dot != std::string::npos) text.resize(dot);
    return text;
  }

  Body body_;
  const std::string& path_;
  TriangleMesh mesh_;
  std::vector<double> corners_;
  std::vector<Face> faces_;
};

}  // namespace

TriangleMesh read_ply_mesh(const std::filesystem::path& path) {
  const std::string name = path.string(), file = read_file(path);
  const std::string_view bytes = without_byte_order_mark(file);
  const Header header = ply::read_header(bytes, name);
  constexpr bool kIsBigHere = std::endian::native == std::endian::big;
  TriangleMesh mesh;
  if (header.encoding == Encoding::ascii)
    mesh = MeshReader(TextBody(bytes, header, name), name).read(header);
  else if ((header.encoding == Encoding::big_endian) == kIsBigHere)
    mesh = MeshReader(BinaryBody<false>(bytes, header, name), name).read(header);
  else
    mesh = MeshReader(BinaryBody<true>(bytes, header, name), name).read(header);
  if (mesh.indices.empty()) throw FileError(name, "", "there is no triangle in it");
  return mesh;
}

SceneDesc load_ply(const std::filesystem::path& path, Executor&) {
  SceneDesc desc;
  desc.add(read_ply_mesh(path));
  if (!std::get<TriangleMesh>(desc.geometries[0].shapes).colors.empty()) show_vertex_colors(desc);
  return desc;
}

}  // namespace boxwood::io
