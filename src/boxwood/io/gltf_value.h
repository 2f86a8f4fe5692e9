// gltf_value.h: which number, or color, does the JSON of an extension hold?
//
// What is not there, or of another type, is answered by `otherwise`; nothing here fails.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "boxwood/core/vec.h"

namespace boxwood::io::gltf {

/// A color that is not negative; `otherwise` where there is none that is finite.
inline Vec3 color_of(const std::vector<double>& numbers, Vec3 otherwise) {
  if (numbers.size() < 3) return otherwise;
  const Vec3 color{float(numbers[0]), float(numbers[1]), float(numbers[2])};
  return is_finite(color) ? max(color, Vec3{0, 0, 0}) : otherwise;
}

inline float clamp01(double value) {
  return static_cast<float>(std::fmin(std::fmax(value, 0), 1));
}

using Extensions = tinygltf::ExtensionMap;

/// A member of a JSON object; null when there is none.
inline const tinygltf::Value* member(const tinygltf::Value* object, const char* name) {
  if (object == nullptr || !object->IsObject() || !object->Has(name)) return nullptr;
  return &object->Get(std::string(name));
}
/// The same of an extension that is an object.
inline const tinygltf::Value* extension(const Extensions& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

inline double number(const tinygltf::Value* object, const char* name, double otherwise) {
  const tinygltf::Value* value = member(object, name);
  return value != nullptr && value->IsNumber() ? value->GetNumberAsDouble() : otherwise;
}

/// Up to `count` numbers of an array; `otherwise` for what is not there.
inline std::array<double, 3> numbers(const tinygltf::Value* object, const char* name,
                                     std::array<double, 3> otherwise, std::size_t count) {
  const tinygltf::Value* value = member(object, name);
  if (value == nullptr || !value->IsArray() || value->ArrayLen() < count) return otherwise;
  for (std::size_t i = 0; i < count; ++i)
    if (const tinygltf::Value& item = value->Get(static_cast<int>(i)); item.IsNumber())
      otherwise[i] = item.GetNumberAsDouble();
  return otherwise;
}

inline Vec3 color(const tinygltf::Value* object, const char* name, Vec3 otherwise) {
  const auto [x, y, z] = numbers(object, name, {otherwise.x, otherwise.y, otherwise.z}, 3);
  return color_of({x, y, z}, otherwise);
}

inline int whole_number(const tinygltf::Value* object, const char* name, int otherwise) {
  const tinygltf::Value* value = member(object, name);
  return value != nullptr && value->IsInt() ? value->GetNumberAsInt() : otherwise;
}

}  // namespace boxwood::io::gltf
