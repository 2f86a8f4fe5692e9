// gltf_source.h: what do tests of the glTF reader begin with? A file in parts that a test can replace.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "boxwood/core/error.h"
#include "boxwood/io/load.h"
#include "io/files.h"

namespace boxwood::io {

inline std::string base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

template <class T>
void append(std::string& bytes, std::initializer_list<T> values) {
  for (const T value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A file in parts that a test can replace.
struct Source {
  std::string buffer;
  std::map<std::string, std::string> parts;  // top-level JSON members

  /// One triangle: positions at byte 0, indices (bytes) at byte 36.
  Source() {
    append<float>(buffer, {0, 0, 0, 1, 0, 0, 0, 1, 0});
    append<std::uint8_t>(buffer, {0, 1, 2, 0});
    parts = {
        {"asset", R"({"version":"2.0"})"},
        {"scenes", R"([{"nodes":[0]}])"},
        {"nodes", R"([{"mesh":0}])"},
        {"meshes", R"([{"name":"tri","primitives":[{"attributes":{"POSITION":0},"indices":1}]}])"},
        {"accessors", R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                          {"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}])"},
        {"bufferViews", R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}])"},
    };
  }
  std::string json(bool is_binary) const {
    std::string text = "{\"buffers\":[{\"byteLength\":" + std::to_string(buffer.size());
    if (!is_binary) text += ",\"uri\":\"data:application/octet-stream;base64," + base64(buffer) + "\"";
    text += "}]";
    for (const auto& [name, value] : parts) text += ",\"" + name + "\":" + value;
    return text + "}";
  }
  std::string glb() const {
    std::string text = json(true), data = buffer, out = "glTF";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4, '\0');
    append<std::uint32_t>(
        out, {2, std::uint32_t(28 + text.size() + data.size()), std::uint32_t(text.size()), 0x4e4f534a});
    out += text;
    append<std::uint32_t>(out, {std::uint32_t(data.size()), 0x004e4942});
    return out + data;
  }
};

class Gltf : public Files {
 protected:
  SceneDesc scene(const Source& source) { return load(write("a.gltf", source.json(false))); }
  std::string error(const Source& source) {
    return message_of<FileError>([&] { (void)scene(source); });
  }
  static const TriangleMesh& mesh(const SceneDesc& desc, std::size_t i = 0) {
    return std::get<TriangleMesh>(desc.geometries.at(i).shapes);
  }
};

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

inline void expect_near(Vec3 a, Vec3 b) {
  EXPECT_LE(length(a - b), 1e-5f) << "(" << a.x << " " << a.y << " " << a.z << ") instead of (" << b.x << " "
                                  << b.y << " " << b.z << ")";
}

}  // namespace boxwood::io
