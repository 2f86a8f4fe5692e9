#include "boxwood/scene/fingerprint.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace boxwood {
namespace {

/// Stirs words into one: a multiplication carries each bit upwards, a shift brings the upper ones back.
class Stirrer {
 public:
  void bytes(const void* data, std::size_t size) {
    const char* at = static_cast<const char*>(data);
    for (; size >= 8; at += 8, size -= 8) {
      std::uint64_t word;
      std::memcpy(&word, at, 8);
      stir(word);
    }
    std::uint64_t rest = 0;
    if (size > 0) std::memcpy(&rest, at, size);  // an empty span has no address
    stir(rest ^ static_cast<std::uint64_t>(size) << 56);
  }
  std::uint64_t value() const { return state_; }

 private:
  void stir(std::uint64_t word) {
    state_ = (state_ ^ word) * 0x9e3779b97f4a7c15u;
    state_ ^= state_ >> 29;
  }
  std::uint64_t state_ = 0x243f6a8885a308d3u;
};

/// Types whose bytes are all value: no padding, no pointers.
template <class T>
inline constexpr bool is_plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <>
inline constexpr bool is_plain<Vec2> = true;
template <>
inline constexpr bool is_plain<Vec3> = true;
template <>
inline constexpr bool is_plain<Affine3> = true;
template <>
inline constexpr bool is_plain<Sphere> = true;
template <>
inline constexpr bool is_plain<Quad> = true;
template <>
inline constexpr bool is_plain<Cuboid> = true;
template <>
inline constexpr bool is_plain<Disk> = true;
template <>
inline constexpr bool is_plain<Box3> = true;
template <class Tag>
inline constexpr bool is_plain<Id<Tag>> = true;
template <class T, std::size_t n>
inline constexpr bool is_plain<std::array<T, n>> = is_plain<T>;

template <class T>
requires is_plain<T>
void add(Stirrer& stirrer, const T& value) {
  stirrer.bytes(&value, sizeof(T));
}

// Each of these names all members of its type, and does not compile when one is added:
// whoever adds one decides here whether it can be seen.
void add(Stirrer& stirrer, const AnyShape& shape);
void add(Stirrer& stirrer, const TriangleMesh& mesh);
void add(Stirrer& stirrer, const Geometry& geometry);
void add(Stirrer& stirrer, const Instance& instance);
void add(Stirrer& stirrer, const Texture& texture);
void add(Stirrer& stirrer, const Material& material);
void add(Stirrer& stirrer, const Camera& camera);
void add(Stirrer& stirrer, const Sky& sky);
void add(Stirrer& stirrer, const PointLight& light);
void add(Stirrer& stirrer, const SpotLight& light);
void add(Stirrer& stirrer, const DistantLight& light);
void add(Stirrer& stirrer, const Environment& environment);
void add(Stirrer& stirrer, const Image& image);
void add(Stirrer& stirrer, const Texture::Operand& operand);
void add(Stirrer& stirrer, const NumberTexture& number);
void add(Stirrer& stirrer, const PictureSource& source);

template <class T>
void add(Stirrer& stirrer, const std::vector<T>& values) {
  add(stirrer, values.size());
  if constexpr (is_plain<T>) {
    stirrer.bytes(values.data(), values.size() * sizeof(T));
  } else {
    for (const T& value : values) add(stirrer, value);
  }
}

template <class T>
void add(Stirrer& stirrer, const std::optional<T>& value) {
  add(stirrer, value.has_value());
  if (value) add(stirrer, *value);
}

template <class... T>
void add_all(Stirrer& stirrer, const T&... values) {
  (add(stirrer, values), ...);
}

void add(Stirrer& stirrer, const AnyShape& shape) {
  add(stirrer, shape.box());
}

void add(Stirrer& stirrer, const TriangleMesh& mesh) {
  const auto& [positions, indices, normals, uvs, second_uvs, colors] = mesh;
  add_all(stirrer, positions, indices, normals, uvs, second_uvs, colors);
}

void add(Stirrer& stirrer, const Geometry& geometry) {
  const auto& [shapes, material, materials, name] = geometry;
  add_all(stirrer, shapes.index(), material, materials);
  std::visit([&stirrer](const auto& some) { add(stirrer, some); }, shapes);
}

void add(Stirrer& stirrer, const Instance& instance) {
  const auto& [geometry, world_from_object, material] = instance;
  add_all(stirrer, geometry, world_from_object, material);
}

void add(Stirrer& stirrer, const Texture& texture) {
  const auto& [name, width, height, texels, is_srgb, kind, wrap_u, wrap_v, is_inverted, is_mixed, first,
               second, amount, u_axis, v_axis, offset, is_by_second_uvs, source] = texture;
  add_all(stirrer, width, height, texels, is_srgb, kind, wrap_u, wrap_v, is_inverted, is_mixed, first, second,
          amount, u_axis, v_axis, offset, is_by_second_uvs);
  if (source) add(stirrer, *source);
}

void add(Stirrer& stirrer, const Texture::Operand& operand) {
  const auto& [color, texture] = operand;
  add_all(stirrer, color, texture);
}

void add(Stirrer& stirrer, const NumberTexture& number) {
  const auto& [texture, channel] = number;
  add_all(stirrer, texture, channel);
}

/// A picture that stays in its file is told by its size and a few texels.
void add(Stirrer& stirrer, const PictureSource& source) {
  add_all(stirrer, source.width(), source.height(), source.levels());
  const int last = source.levels() - 1;
  const int first_small = last < 3 ? 0 : last - 3;
  const int width = std::max(source.width() >> first_small, 1),
            height = std::max(source.height() >> first_small, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) add(stirrer, source.texel(first_small, x, y));
}

void add(Stirrer& stirrer, const Material& material) {
  const auto& [name, kind, color, color_texture, roughness, ior, emission, emits_from_both_sides,
               emission_texture, roughness_texture, roughness_scale, metal_eta, metal_k, reflection_color,
               transmission_color, transmission_color_texture, is_thin, absorption, outer_absorption, opacity,
               opacity_texture, alpha_cutoff, normal_texture, normal_scale, bump, bump_texture, metalness,
               transmission, metalness_texture, transmission_texture, specular, specular_color,
               specular_texture, specular_color_texture, coat, coat_roughness, coat_texture,
               coat_roughness_texture, coat_normal_texture, coat_normal_scale, sheen_color, sheen_roughness,
               sheen_color_texture, sheen_roughness_texture, mix_first, mix_second, mix_amount, mix_texture] =
      material;
  add_all(stirrer, kind, color, color_texture, roughness, ior, emission, emits_from_both_sides,
          emission_texture, roughness_texture, roughness_scale, metal_eta, metal_k, reflection_color,
          transmission_color, transmission_color_texture, is_thin, absorption, outer_absorption, opacity,
          opacity_texture, alpha_cutoff, normal_texture, normal_scale, bump, bump_texture, metalness,
          transmission, metalness_texture, transmission_texture, specular, specular_color, specular_texture,
          specular_color_texture, coat, coat_roughness, coat_texture, coat_roughness_texture,
          coat_normal_texture, coat_normal_scale, sheen_color, sheen_roughness, sheen_color_texture,
          sheen_roughness_texture, mix_first, mix_second, mix_amount, mix_texture);
}

void add(Stirrer& stirrer, const Camera& camera) {
  const auto& [world_from_camera, fov_deg, lens_radius, focus_distance, width, height, orthographic_size] =
      camera;
  add_all(stirrer, world_from_camera, fov_deg, lens_radius, focus_distance, orthographic_size);
}

void add(Stirrer& stirrer, const Sky& sky) {
  const auto& [zenith, horizon, ground, up, sun_direction, sun_radiance, sun_angle_deg] = sky;
  add_all(stirrer, zenith, horizon, ground, up, sun_direction, sun_radiance, sun_angle_deg);
}

void add(Stirrer& stirrer, const PointLight& light) {
  const auto& [position, intensity] = light;
  add_all(stirrer, position, intensity);
}

void add(Stirrer& stirrer, const SpotLight& light) {
  const auto& [position, direction, intensity, inner_cosine, outer_cosine] = light;
  add_all(stirrer, position, direction, intensity, inner_cosine, outer_cosine);
}

void add(Stirrer& stirrer, const Image& image) {
  const auto& [width, height, channels, pixels, channel_names] = image;
  add_all(stirrer, width, height, channels, pixels);
}

void add(Stirrer& stirrer, const Environment& environment) {
  const auto& [world_from_environment, radiance, scale] = environment;
  add_all(stirrer, world_from_environment, radiance, scale);
}

void add(Stirrer& stirrer, const DistantLight& light) {
  const auto& [direction, irradiance] = light;
  add_all(stirrer, direction, irradiance);
}

}  // namespace

std::uint64_t fingerprint(const SceneDesc& desc) {
  Stirrer stirrer;
  const auto& [geometries, instances, materials, textures, point_lights, spot_lights, distant_lights,
               environments, camera, sky, is_lit_by_glow, bounces, name, warnings] = desc;
  // The bounces are a wish; those that are made count with the picture.
  (void)bounces;
  add_all(stirrer, geometries, instances, materials, textures, point_lights, spot_lights, distant_lights,
          environments, camera, sky, is_lit_by_glow);
  return stirrer.value();
}

}  // namespace boxwood
