#include "boxwood/render/texture.h"

#include "boxwood/scene/srgb.h"

namespace boxwood::render {
namespace {

/// Linear light for each 8-bit code, by whether it is sRGB.
struct DecodeTables {
  float linear[256], srgb[256];
  DecodeTables() {
    for (int code = 0; code < 256; ++code) {
      linear[code] = static_cast<float>(code) / 255;
      srgb[code] = linear_from_srgb(linear[code]);
    }
  }
};
const DecodeTables kDecode;

/// `i` modulo `n`, never negative.
int wrap(std::int64_t i, int n) {
  const auto r = static_cast<int>(i % n);
  return r < 0 ? r + n : r;
}

}  // namespace

Vec3 texture_color(const Texture& texture, Vec2 uv) {
  if (texture.texels.empty() || !std::isfinite(uv.x) || !std::isfinite(uv.y)) return {1, 1, 1};

  // Texel centers are at halves.
  // Far out, where floats have no fraction left, the answer only has to be some texel.
  const double x = (uv.x - std::floor(double(uv.x))) * texture.width - 0.5;
  const double y = (1 - (uv.y - std::floor(double(uv.y)))) * texture.height - 0.5;
  const double floor_x = std::floor(x), floor_y = std::floor(y);
  const auto right = static_cast<float>(x - floor_x), down = static_cast<float>(y - floor_y);
  const int x0 = wrap(std::int64_t(floor_x), texture.width), x1 = wrap(std::int64_t(x0) + 1, texture.width);
  const int y0 = wrap(std::int64_t(floor_y), texture.height), y1 = wrap(std::int64_t(y0) + 1, texture.height);

  const float* decode = texture.is_srgb ? kDecode.srgb : kDecode.linear;
  const auto texel = [&](int column, int row) {
    const auto& t = texture.texels[std::size_t(row) * texture.width + column];
    return Vec3{decode[t[0]], decode[t[1]], decode[t[2]]};
  };
  const Vec3 upper = texel(x0, y0) * (1 - right) + texel(x1, y0) * right;
  const Vec3 lower = texel(x0, y1) * (1 - right) + texel(x1, y1) * right;
  return upper * (1 - down) + lower * down;
}

}  // namespace boxwood::render
