// ply_header.h: what does this PLY file say is in it?
//
// The header is text in every encoding: a list of elements, each with a count and typed properties. Nothing
// of it is believed here beyond its form; whoever reads the body compares the counts with the bytes that are
// there.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::io::ply {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class Encoding { ascii, little_endian, big_endian };

constexpr std::size_t size_of(Type type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<int>(type)];
}

struct Property {
  std::string name;
  Type type = Type::float32;
  std::optional<Type> count_type;  ///< Given for lists: the type of their length.
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  std::optional<std::size_t> find(std::initializer_list<const char*> names) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
      for (const char* wanted : names)
        if (properties[i].name == wanted) return i;
    return std::nullopt;
  }
};

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::size_t size_bytes = 0;  ///< Where the values begin: the byte after the header.
  std::size_t lines = 0;       ///< The line there, counted from 1.
};

/// Throws FileError with the line where the header is wrong.
Header read_header(std::string_view bytes, const std::string& path);

}  // namespace boxwood::io::ply
