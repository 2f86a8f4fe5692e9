#include "boxwood/io/picture_cache.h"

#include <array>
#include <atomic>
#include <vector>

#include <OpenImageIO/imagecache.h>

#include "boxwood/io/file_bytes.h"
#include "boxwood/io/image.h"

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

/// A thread's own copies of the tiles that it asked for last.
struct TileMemo {
  static constexpr std::size_t kTiles = 64;
  struct Tile {
    std::uint64_t picture = 0;  // serial number; 0: empty
    int level = 0, x = 0, y = 0;
    std::vector<float> rgba;
  };
  std::array<Tile, kTiles> tiles;
};

class CachedPicture final : public PictureSource {
 public:
  CachedPicture(const std::filesystem::path& path, int width, int height, int channels)
      : file_(path.string()), width_(width), height_(height), channels_(channels) {
    static std::atomic<std::uint64_t> made = 0;
    serial_ = ++made;
    for (int side = std::max(width, height); side > 1; side /= 2) ++levels_;
  }

  int width() const override { return width_; }
  int height() const override { return height_; }
  int levels() const override { return levels_; }

  std::array<float, 4> texel(int level, int x, int y) const override {
    const TileMemo::Tile& tile = this->tile(level, x / kTileSide, y / kTileSide);
    const float* p = &tile.rgba[4 * (std::size_t(y % kTileSide) * kTileSide + x % kTileSide)];
    return {p[0], p[1], p[2], p[3]};
  }

 private:
  const TileMemo::Tile& tile(int level, int x, int y) const {
    static thread_local TileMemo memo;
    const std::size_t slot =
        (serial_ * 31 + std::size_t(level) * 17 + std::size_t(x) + std::size_t(y) * 7) % TileMemo::kTiles;
    TileMemo::Tile& tile = memo.tiles[slot];
    if (tile.picture == serial_ && tile.level == level && tile.x == x && tile.y == y) return tile;
    read(tile, level, x, y);
    tile.picture = serial_;
    tile.level = level;
    tile.x = x;
    tile.y = y;
    return tile;
  }

  void read(TileMemo::Tile& tile, int level, int x, int y) const {
    tile.rgba.assign(std::size_t(kTileSide) * kTileSide * 4, 1.0f);
    const int x0 = x * kTileSide, y0 = y * kTileSide;
    const int columns = std::min(kTileSide, std::max(width_ >> level, 1) - x0),
              rows = std::min(kTileSide, std::max(height_ >> level, 1) - y0);
    const int channels = std::min(channels_, 4);
    std::vector<float> values(std::size_t(columns) * rows * channels);
    // A file that has gone since it was opened is white.
    if (!cache().get_pixels(OIIO::ustring(file_), 0, level, x0, x0 + columns, y0, y0 + rows, 0, 1, 0,
                            channels, OIIO::TypeDesc::FLOAT, values.data())) {
      (void)cache().geterror();
      return;
    }
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const float* from = &values[(std::size_t(row) * columns + column) * channels];
        float* to = &tile.rgba[4 * (std::size_t(row) * kTileSide + column)];
        // One channel is a grey, two a grey with alpha.
        for (int c = 0; c < 3; ++c) to[c] = from[channels >= 3 ? c : 0];
        to[3] = channels == 4 ? from[3] : channels == 2 ? from[1] : 1.0f;
      }
  }

  std::string file_;
  std::uint64_t serial_;
  int width_, height_, channels_, levels_ = 1;
};

}  // namespace

Texture open_texture(const std::filesystem::path& path) {
  // Read it whole once, with all checks: what a codec may choke on is met here, and not in the midst of a
  // picture.
  Texture texture = read_texture(path);
  OIIO::ImageSpec spec;
  if (!cache().get_imagespec(OIIO::ustring(path.string()), spec)) {
    (void)cache().geterror();
    return texture;  // it stays in memory
  }
  texture.source = std::make_shared<CachedPicture>(path, texture.width, texture.height, spec.nchannels);
  texture.texels = {};
  // What the file holds, not what it was encoded as in memory.
  if (spec.format.is_floating_point() || spec["oiio:ColorSpace"].get() == "Linear") texture.is_srgb = false;
  return texture;
}

}  // namespace boxwood::io
