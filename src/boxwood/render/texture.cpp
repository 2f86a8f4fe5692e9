#include "boxwood/render/texture.h"

#include <algorithm>

#include "boxwood/scene/srgb.h"

namespace boxwood::render {
namespace {

/// Linear light for each 8-bit code, by whether it is sRGB; and for finer sRGB codes.
struct DecodeTables {
  static constexpr int kFine = 4096;
  float linear[256], srgb[256], fine_srgb[kFine];
  DecodeTables() {
    for (int code = 0; code < kFine; ++code)
      fine_srgb[code] = linear_from_srgb(static_cast<float>(code) / (kFine - 1));
    for (int code = 0; code < 256; ++code) {
      linear[code] = static_cast<float>(code) / 255;
      srgb[code] = linear_from_srgb(linear[code]);
    }
  }
};
const DecodeTables kDecode;

/// The column or row that `i` means; -1 for black.
int wrap(std::int64_t i, int n, Texture::Wrap how) {
  if (i >= 0 && i < n) return static_cast<int>(i);
  switch (how) {
    case Texture::Wrap::clamp:
      return i < 0 ? 0 : n - 1;
    case Texture::Wrap::black:
      return -1;
    case Texture::Wrap::mirror: {
      std::int64_t r = i % (2 * std::int64_t(n));
      if (r < 0) r += 2 * std::int64_t(n);
      return static_cast<int>(r < n ? r : 2 * std::int64_t(n) - 1 - r);
    }
    case Texture::Wrap::repeat:
      break;
  }
  const auto r = static_cast<int>(i % n);
  return r < 0 ? r + n : r;
}

struct Rgba {
  Vec3 color{0, 0, 0};
  float alpha = 0;

  Rgba operator*(float f) const { return {color * f, alpha * f}; }
  Rgba operator+(const Rgba& b) const { return {color + b.color, alpha + b.alpha}; }
};

Rgba decoded(const Texture& texture, const std::array<float, 4>& t) {
  if (!texture.is_srgb) return {{t[0], t[1], t[2]}, t[3]};
  const auto decode = [](float code) {
    const float place = min(max(code, 0.0f), 1.0f) * (DecodeTables::kFine - 1);
    return kDecode.fine_srgb[static_cast<int>(place + 0.5f)];
  };
  return {{decode(t[0]), decode(t[1]), decode(t[2])}, t[3]};
}

Rgba texel_of(const Texture& texture, int level, int width, int x, int y) {
  if (x < 0 || y < 0) return {};
  if (texture.source) return decoded(texture, texture.source->texel(level, x, y));
  const auto& t = texture.texels[std::size_t(y) * width + x];
  const float* decode = texture.is_srgb ? kDecode.srgb : kDecode.linear;
  return {{decode[t[0]], decode[t[1]], decode[t[2]]}, kDecode.linear[t[3]]};
}

/// Far out, where floats have no fraction left, the answer only has to be some texel; what repeats is brought
/// near first.
double near(double x, Texture::Wrap how) {
  if (how == Texture::Wrap::repeat) return x - std::floor(x);
  return std::min(std::max(x, -1e6), 1e6);
}

/// The texel of the finest level at `uv`.
Rgba nearest(const Texture& texture, Vec2 uv) {
  const double x = near(uv.x, texture.wrap_u) * texture.width;
  const double y = near(1 - double(uv.y), texture.wrap_v) * texture.height;
  return texel_of(texture, 0, texture.width,
                  wrap(static_cast<std::int64_t>(std::floor(x)), texture.width, texture.wrap_u),
                  wrap(static_cast<std::int64_t>(std::floor(y)), texture.height, texture.wrap_v));
}

/// The four texels of a level around `uv`, mixed.
Rgba bilinear(const Texture& texture, int level, Vec2 uv) {
  const int width = std::max(texture.width >> level, 1), height = std::max(texture.height >> level, 1);
  const double x = near(uv.x, texture.wrap_u) * width - 0.5;  // texel centers are at halves
  const double y = near(1 - double(uv.y), texture.wrap_v) * height - 0.5;
  const double floor_x = std::floor(x), floor_y = std::floor(y);
  const auto right = static_cast<float>(x - floor_x), down = static_cast<float>(y - floor_y);
  const int x0 = wrap(std::int64_t(floor_x), width, texture.wrap_u),
            x1 = wrap(std::int64_t(floor_x) + 1, width, texture.wrap_u);
  const int y0 = wrap(std::int64_t(floor_y), height, texture.wrap_v),
            y1 = wrap(std::int64_t(floor_y) + 1, height, texture.wrap_v);
  std::array<Rgba, 4> texels;
  if (texture.source && std::min(std::min(x0, x1), std::min(y0, y1)) >= 0) {
    const auto codes = texture.source->texels(level, x0, x1, y0, y1);
    for (std::size_t i = 0; i < 4; ++i) texels[i] = decoded(texture, codes[i]);
  } else {
    const auto texel = [&](int column, int row) { return texel_of(texture, level, width, column, row); };
    texels = {texel(x0, y0), texel(x1, y0), texel(x0, y1), texel(x1, y1)};
  }
  const Rgba upper = texels[0] * (1 - right) + texels[1] * right;
  const Rgba lower = texels[2] * (1 - right) + texels[3] * right;
  return upper * (1 - down) + lower * down;
}

Texel picture_at(const Texture& texture, Vec2 uv, float width) {
  if (!texture.source && texture.texels.empty()) return {{1, 1, 1}, 1};
  // The level whose texels are as wide as the square that is looked at.
  const int levels = texture.source ? texture.source->levels() : 1;
  const float texels = width * static_cast<float>(std::max(texture.width, texture.height));
  const float level = texels > 1 ? min(std::log2(texels), static_cast<float>(levels - 1)) : 0.0f;
  const int finer = static_cast<int>(level);
  const float share = level - static_cast<float>(finer);
  Rgba value = texture.is_mixed || level > 0 ? bilinear(texture, finer, uv) : nearest(texture, uv);
  if (share > 0) value = value * (1 - share) + bilinear(texture, finer + 1, uv) * share;
  if (texture.is_inverted) value.color = splat(1) - value.color;
  return {value.color, value.alpha};
}

Texel operand_at(const SceneDesc& desc, const Texture::Operand& operand, const TexturePoint& point) {
  if (!operand.texture.is_valid()) return {operand.color, 1};
  const Texel texel = texture_at(desc, operand.texture, point);
  return {operand.color * texel.color, texel.alpha};
}

}  // namespace

Texel texture_at(const SceneDesc& desc, TextureId id, const TexturePoint& point) {
  const Texture& texture = desc.textures[id.value];
  const Vec2 uv = texture.is_by_second_uvs ? point.second_uv : point.uv;
  const Vec2 st{texture.u_axis.x * uv.x + texture.v_axis.x * uv.y + texture.offset.x,
                texture.u_axis.y * uv.x + texture.v_axis.y * uv.y + texture.offset.y};
  if (!std::isfinite(st.x) || !std::isfinite(st.y)) return {{1, 1, 1}, 1};
  const float scale =
      std::sqrt(std::fabs(texture.u_axis.x * texture.v_axis.y - texture.u_axis.y * texture.v_axis.x));
  const float own_width = (texture.is_by_second_uvs ? point.second_width : point.width) * scale;

  switch (texture.kind) {
    case Texture::Kind::picture:
      return picture_at(texture, st, own_width);
    case Texture::Kind::vertex_color:
      return {{point.color[0], point.color[1], point.color[2]}, point.color[3]};
    case Texture::Kind::product: {
      const Texel a = operand_at(desc, texture.first, point), b = operand_at(desc, texture.second, point);
      return {a.color * b.color, a.alpha * b.alpha};
    }
    case Texture::Kind::mix: {
      const Texel a = operand_at(desc, texture.first, point), b = operand_at(desc, texture.second, point);
      const Vec3 share = operand_at(desc, texture.amount, point).color;
      return {a.color * (splat(1) - share) + b.color * share, a.alpha * (1 - share.x) + b.alpha * share.x};
    }
    case Texture::Kind::checkerboard: {
      const double sum = std::floor(double(st.x)) + std::floor(double(st.y));
      const bool is_first = sum - 2 * std::floor(sum / 2) == 0;
      return operand_at(desc, is_first ? texture.first : texture.second, point);
    }
  }
  return {{1, 1, 1}, 1};
}

float number_at(const SceneDesc& desc, const NumberTexture& number, const TexturePoint& point) {
  if (!number.texture.is_valid()) return 1;
  TexturePoint sharp = point;
  sharp.width = sharp.second_width = 0;
  const Texel texel = texture_at(desc, number.texture, sharp);
  switch (number.channel) {
    case NumberTexture::Channel::red:
      return texel.color.x;
    case NumberTexture::Channel::green:
      return texel.color.y;
    case NumberTexture::Channel::blue:
      return texel.color.z;
    case NumberTexture::Channel::alpha:
      return texel.alpha;
    case NumberTexture::Channel::mean:
      break;
  }
  return (texel.color.x + texel.color.y + texel.color.z) / 3;
}

}  // namespace boxwood::render
