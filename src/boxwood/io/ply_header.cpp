#include "boxwood/io/ply_header.h"

#include "boxwood/io/text_scanner.h"

namespace boxwood::io::ply {
namespace {

std::optional<Type> to_type(std::string_view word) {
  constexpr struct {
    const char* name;
    Type type;
  } kNames[] = {{"char", Type::int8},      {"int8", Type::int8},       {"uchar", Type::uint8},
                {"uint8", Type::uint8},    {"short", Type::int16},     {"int16", Type::int16},
                {"ushort", Type::uint16},  {"uint16", Type::uint16},   {"int", Type::int32},
                {"int32", Type::int32},    {"uint", Type::uint32},     {"uint32", Type::uint32},
                {"float", Type::float32},  {"float32", Type::float32}, {"double", Type::float64},
                {"float64", Type::float64}};
  for (const auto& [name, type] : kNames)
    if (word == name) return type;
  return std::nullopt;
}

Type read_type(TextScanner& scanner) {
  const std::string_view word = scanner.word_on_line();
  const std::optional<Type> type = to_type(word);
  if (!type) scanner.fail("a property has type " + in_quotes(word) + ", which PLY does not know");
  return *type;
}

}  // namespace

Header read_header(std::string_view bytes, const std::string& path) {
  TextScanner scanner(bytes, path);
  if (scanner.word_on_line() != "ply") scanner.fail("does not begin with 'ply'");
  Header header;
  bool has_format = false;
  for (;;) {
    if (!scanner.next_line()) scanner.fail("the header has no 'end_header'");
    const std::string_view keyword = scanner.word_on_line();
    if (keyword == "end_header") break;
    if (keyword == "format") {
      const std::string_view encoding = scanner.word_on_line();
      if (encoding == "ascii")
        header.encoding = Encoding::ascii;
      else if (encoding == "binary_little_endian")
        header.encoding = Encoding::little_endian;
      else if (encoding == "binary_big_endian")
        header.encoding = Encoding::big_endian;
      else
        scanner.fail("format " + in_quotes(encoding) +
                     " is not one of ascii, binary_little_endian, binary_big_endian");
      has_format = true;
    } else if (keyword == "element") {
      Element element;
      element.name = scanner.word_on_line();
      const std::string_view word = scanner.word_on_line();
      std::int64_t count;
      if (!parse_int(word, count) || count < 0)
        scanner.fail("element " + in_quotes(element.name) + " has count " + in_quotes(word) +
                     ", expected a whole number");
      element.count = static_cast<std::uint64_t>(count);
      header.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      if (header.elements.empty()) scanner.fail("a property comes before any element");
      Property property;
      const std::string_view word = scanner.word_on_line();
      if (word == "list") {
        property.count_type = read_type(scanner);
        if (*property.count_type >= Type::float32) scanner.fail("the length of a list is not a whole number");
        property.type = read_type(scanner);
      } else if (const std::optional<Type> type = to_type(word)) {
        property.type = *type;
      } else {
        scanner.fail("a property has type " + in_quotes(word) + ", which PLY does not know");
      }
      property.name = scanner.word_on_line();
      header.elements.back().properties.push_back(std::move(property));
    } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
      scanner.fail(in_quotes(keyword) + " does not belong in the header");
    }
  }
  if (!has_format) scanner.fail("the header has no 'format'");
  scanner.next_line();
  header.size_bytes = scanner.offset();
  header.lines = scanner.line();
  return header;
}

}  // namespace boxwood::io::ply
