#include "boxwood/io/load.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>

#include "boxwood/io/file_bytes.h"
#include "boxwood/io/formats.h"

namespace boxwood::io {
namespace {

struct Format {
  const char* extension;
  SceneDesc (*read)(const std::filesystem::path&, Executor&);
};

// Every format that load() reads, by the ending of the file's name.
constexpr Format kFormats[] = {
    {".obj", load_obj},   {".ply", load_ply},  {".stl", load_stl},
    {".gltf", load_gltf}, {".glb", load_gltf}, {".pbrt", load_pbrt},
};

const Format* find_format(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  for (const Format& format : kFormats)
    if (extension == format.extension) return &format;
  return nullptr;
}

std::string known_extensions() {
  std::string list;
  for (const Format& format : kFormats) list += (list.empty() ? "" : " ") + std::string(format.extension);
  return list;
}

bool is_direction(Vec3 n) {
  return is_finite(n) && length_squared(n) > 0;
}

// Exporters write zeros or NaN for the normals of slivers. Such vertices get the mean normal of the triangles
// around them, weighted by area.
void mend_normals(TriangleMesh& mesh) {
  if (std::all_of(mesh.normals.begin(), mesh.normals.end(), is_direction)) return;

  std::vector<Vec3> sums(mesh.positions.size());
  for (const auto& [a, b, c] : mesh.indices) {
    const Vec3 doubled_area =
        cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    for (const std::uint32_t vertex : {a, b, c}) sums[vertex] += doubled_area;
  }
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (is_direction(mesh.normals[i])) continue;
    const Vec3 mean = normalize(sums[i]);
    mesh.normals[i] = is_finite(mean) ? mean : Vec3{0, 0, 1};
  }
}

// Texture coordinates that are not finite would poison every picture that looks them up.
void mend_uvs(TriangleMesh& mesh) {
  for (std::vector<Vec2>* uvs : {&mesh.uvs, &mesh.second_uvs})
    for (Vec2& uv : *uvs)
      if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = {0, 0};
}

}  // namespace

bool is_loadable(const std::filesystem::path& path) {
  return find_format(path) != nullptr;
}

SceneDesc load(const std::filesystem::path& path, Executor* executor) {
  const std::string name = path.string();
  const Format* format = find_format(path);
  if (format == nullptr)
    throw FileError(name, "", "its name has none of the endings that can be read: " + known_extensions());

  try {
    SceneDesc desc = format->read(path, executor != nullptr ? *executor : serial_executor());
    if (desc.name.empty()) desc.name = path.stem().string();

    // Hold the file to what every scene is held to, here where the message can still name the file.
    if (defined_primitive_count(desc) == 0)
      throw FileError(name, "", "there is no triangle or other shape in it");
    check(desc);
    for (Geometry& geometry : desc.geometries)
      if (auto* mesh = std::get_if<TriangleMesh>(&geometry.shapes)) {
        mend_normals(*mesh);
        mend_uvs(*mesh);
      }
    return desc;
  } catch (const std::invalid_argument& error) {
    throw FileError(name, "", error.what());
  } catch (const std::bad_alloc&) {
    throw FileError(name, "", "needs more memory than there is");
  } catch (const std::length_error&) {
    throw FileError(name, "", "needs more memory than there is");
  }
}

}  // namespace boxwood::io
