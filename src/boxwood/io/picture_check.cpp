#include "boxwood/io/picture_check.h"

#include <algorithm>
#include <array>

#include "boxwood/core/error.h"
#include "boxwood/io/file_bytes.h"

namespace boxwood::io {
namespace {

// Larger pictures are taken for damage, and so are those that tell of more numbers than any encoding packs
// into the bytes of their file. (A bitmap of one value takes a PNG one byte for 8256 pixels, each of which
// becomes four numbers where there is a palette; a flat picture takes an EXR about as little.)
constexpr std::int64_t kMostPixelsAcross = 1 << 16, kMostChannels = 256;
constexpr std::uint64_t kMostValues = 1u << 29, kMostValuesPerByte = 1u << 16;

[[noreturn]] void fail(const std::string& name, std::size_t at, const std::string& message) {
  throw FileError(name, "byte " + std::to_string(at), message);
}

std::uint32_t byte_at(std::string_view bytes, std::size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  return byte_at(bytes, at) | byte_at(bytes, at + 1) << 8 | byte_at(bytes, at + 2) << 16 |
         byte_at(bytes, at + 3) << 24;
}
std::uint32_t big_endian(std::string_view bytes, std::size_t at) {
  return byte_at(bytes, at) << 24 | byte_at(bytes, at + 1) << 16 | byte_at(bytes, at + 2) << 8 |
         byte_at(bytes, at + 3);
}

// The check sum of PNG chunks: ISO/IEC 15948, annex D.
std::uint32_t crc32(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t c = i;
      for (int bit = 0; bit < 8; ++bit) c = c & 1 ? 0xedb88320u ^ c >> 1 : c >> 1;
      table[i] = c;
    }
    return table;
  }();
  std::uint32_t crc = ~0u;
  for (const char c : bytes) crc = kTable[(crc ^ static_cast<unsigned char>(c)) & 255] ^ crc >> 8;
  return ~crc;
}

}  // namespace

void check_picture_size(const std::string& name, std::int64_t width, std::int64_t height,
                        std::int64_t channels, std::size_t file_bytes) {
  const bool is_possible = width > 0 && height > 0 && channels > 0 && width <= kMostPixelsAcross &&
                           height <= kMostPixelsAcross && channels <= kMostChannels;
  if (!is_possible ||
      std::uint64_t(width * height * channels) > std::min(kMostValues, kMostValuesPerByte * file_bytes))
    throw FileError(name, "",
                    "the picture tells of " + std::to_string(width) + " x " + std::to_string(height) +
                        " pixels with " + std::to_string(channels) + " channels, which cannot be in it");
}

void check_exr(std::string_view bytes, const std::string& name) {
  std::size_t at = 8;  // Past the magic number and the version.
  if (bytes.size() < at) fail(name, bytes.size(), "the file ends within its header");
  const bool has_parts = (little_endian(bytes, 4) & 0x1000) != 0;
  const auto text = [&] {
    const std::size_t end = bytes.find('\0', at);
    if (end == std::string_view::npos) fail(name, at, "the file ends within its header");
    const std::string_view found = bytes.substr(at, end - at);
    at = end + 1;
    return found;
  };

  // A header is a list of attributes (a name, a type, a size, a value) that ends with an empty name; a file
  // of several parts has a list of headers that ends with an empty header.
  for (bool is_first = true;; is_first = false) {
    const std::string_view attribute = text();
    if (attribute.empty()) {
      if (!has_parts || is_first || at >= bytes.size() || bytes[at] == '\0') return;
      continue;
    }
    const std::string_view type = text();
    if (bytes.size() - at < 4) fail(name, at, "the file ends within its header");
    const std::uint32_t size = little_endian(bytes, at);
    at += 4;
    if (size > bytes.size() - at)
      fail(name, at,
           "a header attribute tells of " + std::to_string(size) + " bytes, for which the file is too short");
    if (attribute == "dataWindow" && type == "box2i" && size == 16) {
      const auto corner = [&](int i) {
        return std::int64_t(static_cast<std::int32_t>(little_endian(bytes, at + 4 * i)));
      };
      check_picture_size(name, corner(2) - corner(0) + 1, corner(3) - corner(1) + 1, 1, bytes.size());
    }
    at += size;
  }
}

std::string png_essentials(std::string_view bytes, const std::string& name) {
  // A chunk is framed by its length, its type and its check sum.
  constexpr std::size_t kSignature = 8, kFrame = 12;
  constexpr std::string_view kKept[] = {"IHDR", "PLTE", "IDAT", "tRNS", "gAMA", "IEND"};
  if (!bytes.starts_with("\x89PNG\r\n\x1a\n"))
    fail(name, 0, "is not a picture that can be read: no PNG begins so");
  std::string kept(bytes.substr(0, kSignature));
  bool has_pixels = false;
  for (std::size_t at = kSignature;;) {
    if (at > bytes.size() || bytes.size() - at < kFrame)
      fail(name, bytes.size(), "the file ends before its last chunk");
    const std::size_t length = big_endian(bytes, at);
    const std::string_view type = bytes.substr(at + 4, 4);
    if (length > bytes.size() - at - kFrame)
      fail(name, at,
           "a chunk tells of " + std::to_string(length) + " bytes, for which the file is too short");
    if (at == kSignature && (type != "IHDR" || length != 13))
      fail(name, at, "the first chunk is not a header");

    if (std::find(std::begin(kKept), std::end(kKept), type) != std::end(kKept)) {
      if (crc32(bytes.substr(at + 4, 4 + length)) != big_endian(bytes, at + 8 + length))
        fail(name, at, "a chunk does not agree with its check sum");
      if (type == "IHDR")
        check_picture_size(name, big_endian(bytes, at + 8), big_endian(bytes, at + 12), 1, bytes.size());
      has_pixels |= type == "IDAT";
      if (type == "IEND" && !has_pixels) fail(name, at, "there are no pixels before the end");
      kept += bytes.substr(at, kFrame + length);
      if (type == "IEND") return kept;
    }
    at += kFrame + length;
  }
}

std::string picture_format(std::string_view bytes, const std::string& name) {
  constexpr struct {
    std::string_view magic;
    const char* format;
  } kFormats[] = {{"\x89PNG", "png"}, {"\xff\xd8\xff", "jpg"}, {"\x76\x2f\x31\x01", "exr"},
                  {"#?R", "hdr"},     {"GIF8", "gif"},         {"BM", "bmp"}};
  for (const auto& [magic, format] : kFormats)
    if (bytes.starts_with(magic)) return format;
  if (bytes.size() > 12 && bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP") return "webp";
  const std::string extension = lower_extension(name);
  return extension.empty() ? "" : extension.substr(1);
}

std::string checked_picture(std::string_view bytes, const std::string& name) {
  const std::string format = picture_format(bytes, name);
  if (format == "png") return png_essentials(bytes, name);
  if (format == "exr") check_exr(bytes, name);
  return std::string(bytes);
}

}  // namespace boxwood::io
