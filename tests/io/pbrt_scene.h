// pbrt_scene.h: what do tests of the pbrt reader begin with? A scene written to a file and loaded, and what
// it says.
#pragma once

#include <string>

#include "boxwood/core/error.h"
#include "boxwood/io/load.h"
#include "io/files.h"

namespace boxwood::io {

class Pbrt : public Files {
 protected:
  SceneDesc scene(const std::string& text) { return load(write("scene.pbrt", text)); }
  std::string error(const std::string& text) {
    return message_of<FileError>([&] { (void)scene(text); });
  }
  /// Expects an error that names the scene's file and line, and what is wrong.
  void expect_error(const std::string& text, int line, const std::string& part) {
    const std::string message = error(text);
    EXPECT_CONTAINS(message, path("scene.pbrt").string() + ":" + std::to_string(line) + ": ");
    EXPECT_CONTAINS(message, part);
  }
  static const TriangleMesh& mesh(const SceneDesc& desc, std::size_t i = 0) {
    return std::get<TriangleMesh>(desc.geometries.at(i).shapes);
  }
  static const Material& material(const SceneDesc& desc, std::size_t geometry = 0) {
    return desc.materials.at(desc.geometries.at(geometry).material.value);
  }
};

inline const std::string kTriangle =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0  1 0 0  0 1 0]\n";

inline void expect_near(Vec3 a, Vec3 b, float tolerance = 1e-5f) {
  EXPECT_LE(length(a - b), tolerance)
      << "(" << a.x << " " << a.y << " " << a.z << ") instead of (" << b.x << " " << b.y << " " << b.z << ")";
}

inline Vec3 facing(const TriangleMesh& mesh, std::size_t triangle = 0) {
  const auto [a, b, c] = mesh.indices.at(triangle);
  return normalize(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
}

}  // namespace boxwood::io
