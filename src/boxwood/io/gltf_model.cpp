#include "boxwood/io/gltf_model.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <tiny_gltf.h>

#include "boxwood/io/file_bytes.h"

namespace boxwood::io::gltf {
namespace {

// Of the variants the one that a file begins with is shown.
constexpr std::array<std::string_view, 15> kSupportedExtensions = {
    "KHR_lights_punctual",     "KHR_mesh_quantization",      "KHR_materials_emissive_strength",
    "KHR_materials_ior",       "KHR_materials_transmission", "KHR_materials_volume",
    "KHR_materials_clearcoat", "KHR_materials_sheen",        "KHR_materials_specular",
    "KHR_materials_unlit",     "KHR_materials_variants",     "KHR_texture_transform",
    "EXT_texture_webp",        "EXT_mesh_gpu_instancing",    "KHR_materials_pbrSpecularGlossiness"};

/// A library's message in one line that is not too long (tinygltf quotes whole data URIs).
std::string one_line(std::string text) {
  constexpr std::size_t kLongest = 200;
  while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  return text;
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// Finds the JSON of a GLB and checks that every chunk lies within the file.
std::string_view check_container(const File& file, std::string_view bytes) {
  constexpr std::uint32_t kJson = 0x4e4f534a;  // "JSON"
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  if (bytes.size() < kHeader + kChunkHeader)
    file.fail("",
              "the file ends after " + std::to_string(bytes.size()) + " bytes, within the header of a GLB");
  const std::uint32_t version = little_endian(bytes, 4), length = little_endian(bytes, 8);
  if (version != 2) file.fail("byte 4", "this is GLB version " + std::to_string(version) + ", expected 2");
  if (length > bytes.size())
    file.fail("byte 8", "the file should have " + std::to_string(length) + " bytes and ends after " +
                            std::to_string(bytes.size()));
  for (std::size_t at = kHeader; at < length;) {
    const std::size_t left = length - at;
    if (left < kChunkHeader || little_endian(bytes, at) > left - kChunkHeader)
      file.fail("byte " + std::to_string(at), "a chunk of the GLB reaches past the end of the file");
    at += kChunkHeader + little_endian(bytes, at);
  }
  if (length < kHeader + kChunkHeader || little_endian(bytes, 16) != kJson)
    file.fail("byte 16", "the first chunk of the GLB is not JSON");
  return bytes.substr(kHeader + kChunkHeader, little_endian(bytes, 12));
}

/// The JSON parser of the library recurses, so what is nested without end would overflow the stack.
void check_depth(const File& file, std::string_view json) {
  constexpr int kDeepest = 200;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepest)
        file.fail("byte " + std::to_string(i),
                  "the JSON is nested deeper than " + std::to_string(kDeepest) + " levels");
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
}

// What tinygltf calls for files beside the model:
// only regular files, and only by paths that start at the model's folder.
bool file_exists(const std::string& path, void* base) {
  const std::string& folder = *static_cast<const std::string*>(base);
  std::error_code ignored;
  return path.starts_with(folder) && std::filesystem::is_regular_file(path, ignored);
}
std::string same_path(const std::string& path, void*) {
  return path;
}
bool read_whole_file(std::vector<unsigned char>* out, std::string* error, const std::string& path, void*) {
  try {
    const std::string bytes = read_file(path);
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const std::exception& exception) {
    *error = exception.what();
    return false;
  }
}
bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}

/// Keeps a picture's bytes. Those in a buffer stay there:
/// tinygltf hands them over without looking whether they exist.
bool keep_picture(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

bool is_supported(const std::string& extension) {
  return std::find(kSupportedExtensions.begin(), kSupportedExtensions.end(), extension) !=
         kSupportedExtensions.end();
}

void expect_supported(const File& file, const std::vector<std::string>& required) {
  for (const std::string& extension : required)
    if (!is_supported(extension))
      file.fail("extensionsRequired",
                "the file requires the extension " + one_line(extension) + ", which is not supported");
}

/// What a file requires, by its text: what is compressed by an extension does not look like a glTF file to
/// the library.
std::vector<std::string> required_by(std::string_view json) {
  std::vector<std::string> names;
  const std::size_t begin = json.find('[', std::min(json.find("\"extensionsRequired\""), json.size()));
  if (begin == std::string_view::npos) return names;
  std::string_view list = json.substr(begin, json.find(']', begin) - begin);
  for (std::size_t open = list.find('"'); open != std::string_view::npos; open = list.find('"')) {
    const std::size_t close = list.find('"', open + 1);
    if (close == std::string_view::npos) break;
    names.emplace_back(list.substr(open + 1, close - open - 1));
    list.remove_prefix(close + 1);
  }
  return names;
}

}  // namespace

void File::fail(const std::string& place, const std::string& message) const {
  throw FileError(path.string(), place, message);
}

void warn(std::vector<std::string>& warnings, const File& file, const std::string& place,
          const std::string& message) {
  const std::string line = file.path.string() + (place.empty() ? "" : ":" + place) + ": " + message;
  if (std::find(warnings.begin(), warnings.end(), line) == warnings.end()) warnings.push_back(line);
}

File read_model(const std::filesystem::path& path, std::vector<std::string>& warnings) {
  File file{path, {}};
  const std::string bytes = read_file(path);
  if (bytes.size() > 0xffffffffu)
    file.fail("", "the file is larger than 4 GiB, which the format does not allow");
  const bool is_binary = bytes.starts_with("glTF");
  const std::string_view json = is_binary ? check_container(file, bytes) : std::string_view(bytes);
  check_depth(file, json);

  std::string base = path.parent_path().string();
  if (base.empty()) base = ".";
  if (!base.ends_with('/')) base += '/';
  tinygltf::TinyGLTF reader;
  reader.SetImageLoader(keep_picture, nullptr);
  reader.SetFsCallbacks({file_exists, same_path, read_whole_file, write_nothing, &base});

  const auto model = std::make_shared<tinygltf::Model>();
  std::string error, unused_warnings;
  bool is_read = false;
  try {
    const auto size = static_cast<unsigned int>(bytes.size());
    is_read =
        is_binary
            ? reader.LoadBinaryFromMemory(model.get(), &error, &unused_warnings,
                                          reinterpret_cast<const unsigned char*>(bytes.data()), size, base)
            : reader.LoadASCIIFromString(model.get(), &error, &unused_warnings, bytes.data(), size, base);
  } catch (const std::exception& exception) {  // of the library, or out of memory
    error = exception.what();
  }
  if (!is_read) expect_supported(file, required_by(json));
  if (!is_read) file.fail("", "this is not a glTF file that can be read: " + one_line(error));
  if (!model->asset.version.starts_with("2."))
    file.fail("asset", "this is glTF version " + one_line(model->asset.version) + ", expected 2");

  expect_supported(file, model->extensionsRequired);
  for (const std::string& extension : model->extensionsUsed)
    if (!is_supported(extension))
      warn(warnings, file, "extensionsUsed",
           "the extension " + one_line(extension) + " is not supported and has no effect");
  file.model = model;
  return file;
}

}  // namespace boxwood::io::gltf
