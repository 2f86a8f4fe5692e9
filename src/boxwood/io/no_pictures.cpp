// no_pictures.cpp: what do the loaders say of pictures in a build that reads none (BOXWOOD_PICTURES=OFF)?
//
// Scenes load without their textures, with a warning for each; geometry is all there.
#include "boxwood/io/image.h"
#include "boxwood/io/picture_cache.h"

namespace boxwood::io {
namespace {

[[noreturn]] void refuse(const std::string& name) {
  throw FileError(name, "", "this build of Boxwood leaves pictures out (BOXWOOD_PICTURES)");
}

}  // namespace

void write_image(const std::filesystem::path& path, const Image&, const ExrOptions&, Lasting) {
  refuse(path.string());
}
ExrFile read_exr(const std::filesystem::path& path) {
  refuse(path.string());
}
Texture open_texture(const std::filesystem::path& path) {
  refuse(path.string());
}
Texture open_texture(std::span<const std::byte>, const std::string& name) {
  refuse(name);
}
Image read_image(const std::filesystem::path& path) {
  refuse(path.string());
}
Texture read_texture(const std::filesystem::path& path) {
  refuse(path.string());
}
Texture read_texture(std::span<const std::byte>, const std::string& name) {
  refuse(name);
}

}  // namespace boxwood::io
