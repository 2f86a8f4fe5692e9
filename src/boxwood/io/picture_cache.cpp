#include "boxwood/io/picture_cache.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagecache.h>

#include "boxwood/io/image.h"
#include "boxwood/io/picture_check.h"

namespace boxwood::io {
namespace {

constexpr int kTileSide = 64;

OIIO::ImageCache& cache() {
  // Never destroyed: threads of the executor may outlive main().
  static OIIO::ImageCache* const shared = [] {
    OIIO::ImageCache* made = OIIO::ImageCache::create(false);
    made->attribute("max_memory_MB", float(kPictureCacheMegabytes));
    made->attribute("autotile", kTileSide);
    made->attribute("automip", 1);
    made->attribute("accept_untiled", 1);
    made->attribute("accept_unmipped", 1);
    made->attribute("unassociatedalpha", 1);
    return made;
  }();
  return *shared;
}

/// A thread's own copies of the tiles that it asked for last, so that most texels cost no lock.
struct TileMemo {
  static constexpr std::size_t kTiles = 256;
  struct Tile {
    std::uint64_t picture = 0;  // serial number; 0: empty
    int level = 0, x = 0, y = 0;
    std::vector<std::uint8_t> bytes;  // RGBA, of pictures of 8 bits
    std::vector<float> floats;        // of others
  };
  std::array<Tile, kTiles> tiles;
};

/// The bytes of a picture file, under a name by which the cache knows them.
class PictureInMemory {
 public:
  PictureInMemory(std::string bytes, const std::string& format)
      : bytes_(std::move(bytes)), reader_(bytes_.data(), bytes_.size()) {
    static std::atomic<std::uint64_t> made = 0;
    name_ = OIIO::ustring("picture in memory " + std::to_string(++made) + "." + format);
    OIIO::ImageSpec wishes;
    OIIO::Filesystem::IOProxy* proxy = &reader_;
    wishes.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    (void)cache().add_file(name_, nullptr, &wishes);
  }
  ~PictureInMemory() { cache().invalidate(name_, true); }  // closes it
  PictureInMemory(const PictureInMemory&) = delete;

  OIIO::ustring name() const { return name_; }

 private:
  std::string bytes_;
  OIIO::Filesystem::IOMemReader reader_;
  OIIO::ustring name_;
};

class CachedPicture final : public PictureSource {
 public:
  /// `memory` is what stands behind the name, or null when that is a file's.
  CachedPicture(OIIO::ustring file, std::unique_ptr<PictureInMemory> memory, int width, int height,
                const OIIO::ImageSpec& spec)
      : memory_(std::move(memory)),
        file_(file),
        width_(width),
        height_(height),
        channels_(std::min(spec.nchannels, 4)),
        has_bytes_(spec.format == OIIO::TypeDesc::UINT8) {
    static std::atomic<std::uint64_t> made = 0;
    serial_ = ++made;
    for (int side = std::max(width, height); side > 1; side /= 2) ++levels_;
  }

  int width() const override { return width_; }
  int height() const override { return height_; }
  int levels() const override { return levels_; }

  std::array<float, 4> texel(int level, int x, int y) const override {
    return texel_of(tile(level, x / kTileSide, y / kTileSide), x, y);
  }

  std::array<std::array<float, 4>, 4> texels(int level, int x0, int x1, int y0, int y1) const override {
    const int column = x0 / kTileSide, row = y0 / kTileSide;
    if (x1 / kTileSide != column || y1 / kTileSide != row)
      return PictureSource::texels(level, x0, x1, y0, y1);
    const TileMemo::Tile& tile = this->tile(level, column, row);
    return {texel_of(tile, x0, y0), texel_of(tile, x1, y0), texel_of(tile, x0, y1), texel_of(tile, x1, y1)};
  }

 private:
  std::array<float, 4> texel_of(const TileMemo::Tile& tile, int x, int y) const {
    const std::size_t at = 4 * (std::size_t(y % kTileSide) * kTileSide + x % kTileSide);
    if (!has_bytes_) return {tile.floats[at], tile.floats[at + 1], tile.floats[at + 2], tile.floats[at + 3]};
    const std::uint8_t* p = &tile.bytes[at];
    constexpr float kUnit = 1 / 255.0f;
    return {p[0] * kUnit, p[1] * kUnit, p[2] * kUnit, p[3] * kUnit};
  }

  const TileMemo::Tile& tile(int level, int x, int y) const {
    static thread_local TileMemo memo;
    const std::size_t slot =
        (serial_ * 37 + std::size_t(level) * 101 + std::size_t(x) + std::size_t(y) * 16) % TileMemo::kTiles;
    TileMemo::Tile& tile = memo.tiles[slot];
    if (tile.picture == serial_ && tile.level == level && tile.x == x && tile.y == y) return tile;
    if (has_bytes_)
      read<std::uint8_t>(tile.bytes, 255, OIIO::TypeDesc::UINT8, level, x, y);
    else
      read<float>(tile.floats, 1, OIIO::TypeDesc::FLOAT, level, x, y);
    tile.picture = serial_;
    tile.level = level;
    tile.x = x;
    tile.y = y;
    return tile;
  }

  template <class T>
  void read(std::vector<T>& rgba, T one, OIIO::TypeDesc type, int level, int x, int y) const {
    rgba.assign(std::size_t(kTileSide) * kTileSide * 4, one);
    const int x0 = x * kTileSide, y0 = y * kTileSide;
    const int columns = std::min(kTileSide, std::max(width_ >> level, 1) - x0),
              rows = std::min(kTileSide, std::max(height_ >> level, 1) - y0);
    std::vector<T> values(std::size_t(columns) * rows * channels_);
    // A file that has gone since it was opened is white.
    if (!cache().get_pixels(file_, 0, level, x0, x0 + columns, y0, y0 + rows, 0, 1, 0, channels_, type,
                            values.data())) {
      (void)cache().geterror();
      return;
    }
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const T* from = &values[(std::size_t(row) * columns + column) * channels_];
        T* to = &rgba[4 * (std::size_t(row) * kTileSide + column)];
        // One channel is a grey, two a grey with alpha.
        for (int c = 0; c < 3; ++c) to[c] = from[channels_ >= 3 ? c : 0];
        to[3] = channels_ == 4 ? from[3] : channels_ == 2 ? from[1] : one;
      }
  }

  std::unique_ptr<PictureInMemory> memory_;
  OIIO::ustring file_;
  std::uint64_t serial_;
  int width_, height_, channels_, levels_ = 1;
  bool has_bytes_;
};

/// Lets the picture that `texture` was read from stay in its file.
Texture left_in_file(Texture texture, OIIO::ustring file, std::unique_ptr<PictureInMemory> memory) {
  OIIO::ImageSpec spec;
  if (!cache().get_imagespec(file, spec)) {
    (void)cache().geterror();
    return texture;  // it stays in memory
  }
  texture.source =
      std::make_shared<CachedPicture>(file, std::move(memory), texture.width, texture.height, spec);
  texture.texels = {};
  // What the file holds, not what it was encoded as in memory.
  if (spec.format.is_floating_point() || spec["oiio:ColorSpace"].get() == "Linear") texture.is_srgb = false;
  return texture;
}

}  // namespace

// A picture is read whole once, with all checks: what a codec may choke on is met here, and not in the midst
// of rendering.

Texture open_texture(const std::filesystem::path& path) {
  Texture texture = read_texture(path);
  const OIIO::ustring file(path.string());
  cache().invalidate(file, true);  // the file may have changed since the cache looked at it
  return left_in_file(std::move(texture), file, nullptr);
}

Texture open_texture(std::span<const std::byte> bytes, const std::string& name) {
  Texture texture = read_texture(bytes, name);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  auto memory = std::make_unique<PictureInMemory>(checked_picture(text, name), picture_format(text, name));
  const OIIO::ustring file = memory->name();
  return left_in_file(std::move(texture), file, std::move(memory));
}

}  // namespace boxwood::io
