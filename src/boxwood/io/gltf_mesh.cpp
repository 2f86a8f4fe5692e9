#include "boxwood/io/gltf_mesh.h"

#include <numeric>

#include <tiny_gltf.h>

#include "boxwood/io/gltf_accessor.h"
#include "boxwood/io/gltf_material.h"

namespace boxwood::io::gltf {
namespace {

/// The accessor of an attribute, or -1.
int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  return found != primitive.attributes.end() ? found->second : -1;
}

/// Triangles from a list, strip or fan of vertices (specification, section 3.7.2.1).
/// What is left over makes none.
std::vector<std::array<std::uint32_t, 3>> triangles_of(const std::vector<std::uint32_t>& v, int mode) {
  std::vector<std::array<std::uint32_t, 3>> out;
  const std::size_t n = v.size();
  if (n < 3) return out;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    out.reserve(n / 3);
    for (std::size_t i = 0; i + 2 < n; i += 3) out.push_back({v[i], v[i + 1], v[i + 2]});
  } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    out.reserve(n - 2);
    for (std::size_t i = 0; i + 2 < n; ++i) out.push_back({v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
  } else {
    out.reserve(n - 2);
    for (std::size_t i = 0; i + 2 < n; ++i) out.push_back({v[i + 1], v[i + 2], v[0]});
  }
  return out;
}

}  // namespace

std::optional<Geometry> read_primitive(const File& file, std::size_t mesh_index, std::size_t primitive_index,
                                       std::vector<std::string>& warnings) {
  const tinygltf::Mesh& source = file.model->meshes[mesh_index];
  const tinygltf::Primitive& primitive = source.primitives[primitive_index];
  std::string where = "mesh " + std::to_string(mesh_index);
  if (!source.name.empty()) where += " '" + source.name + "'";
  where += ", primitive " + std::to_string(primitive_index);

  if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
    file.fail(where, "the mode is " + std::to_string(primitive.mode) + ", expected 0 to 6");
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    warn(warnings, file, where, "points and lines are not supported and left out");
    return std::nullopt;
  }
  const int positions = attribute(primitive, "POSITION");
  if (positions == -1) {
    warn(warnings, file, where, "the primitive has no positions and is left out");
    return std::nullopt;
  }

  TriangleMesh mesh;
  mesh.positions = read_vec3(file, positions, where + ", POSITION");
  const std::size_t vertices = mesh.positions.size();
  const auto check_length = [&](std::size_t length, const std::string& name) {
    if (length != vertices)
      file.fail(where, name + " has " + std::to_string(length) + " elements, expected one for each of the " +
                           std::to_string(vertices) + " positions");
  };
  if (const int normals = attribute(primitive, "NORMAL"); normals != -1) {
    mesh.normals = read_vec3(file, normals, where + ", NORMAL");
    check_length(mesh.normals.size(), "NORMAL");
  }
  const auto read_uvs = [&](int set) {
    const std::string name = "TEXCOORD_" + std::to_string(set);
    const int accessor = attribute(primitive, name);
    if (accessor == -1) return std::vector<Vec2>();
    std::vector<Vec2> uvs = read_vec2(file, accessor, where + ", " + name);
    check_length(uvs.size(), name);
    for (Vec2& uv : uvs) uv.y = 1 - uv.y;  // v points down in glTF, up here
    return uvs;
  };
  if (const int colors = attribute(primitive, "COLOR_0"); colors != -1) {
    mesh.colors = read_colors(file, colors, where + ", COLOR_0");
    check_length(mesh.colors.size(), "COLOR_0");
  }
  const UvSets sets = uv_sets(file, primitive.material);
  mesh.uvs = read_uvs(sets.first);
  if (sets.second) mesh.second_uvs = read_uvs(*sets.second);
  if (sets.second && mesh.second_uvs.empty())
    warn(warnings, file, where,
         "there is no TEXCOORD_" + std::to_string(*sets.second) +
             ", which the material asks for; the material's first set stands in");

  // The order of the vertices: as given, or one after the other.
  std::vector<std::uint32_t> indices;
  if (primitive.indices != -1) {
    indices = read_indices(file, primitive.indices, where + ", indices");
    for (std::size_t i = 0; i < indices.size(); ++i)
      if (indices[i] >= vertices)
        file.fail(where + ", indices, accessor " + std::to_string(primitive.indices),
                  "index " + std::to_string(i) + " is " + std::to_string(indices[i]) + ", but there are " +
                      std::to_string(vertices) + " vertices");
  } else {
    indices.resize(vertices);
    std::iota(indices.begin(), indices.end(), 0u);
  }
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0)
    warn(warnings, file, where,
         "the last triangle has only " + std::to_string(indices.size() % 3) + " vertices and is left out");
  mesh.indices = triangles_of(indices, primitive.mode);

  Geometry geometry{std::move(mesh), {}, {}, source.name};
  if (source.primitives.size() > 1) geometry.name += " " + std::to_string(primitive_index);
  const std::size_t materials = file.model->materials.size();
  if (primitive.material >= 0 && std::size_t(primitive.material) >= materials)
    file.fail(where, "material " + std::to_string(primitive.material) + " does not exist, there are " +
                         std::to_string(materials));
  geometry.material =
      MaterialId(static_cast<std::uint32_t>(primitive.material >= 0 ? primitive.material : materials));
  return geometry;
}

}  // namespace boxwood::io::gltf
