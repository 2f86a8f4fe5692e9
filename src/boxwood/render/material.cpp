#include "boxwood/render/material.h"

#include "boxwood/render/fresnel.h"

namespace boxwood::render {
namespace {

using Kind = Material::Kind;

/// Below this width a lobe is so narrow that single precision cannot hold it apart from a mirror.
constexpr float kSmoothAlpha = 0.001f;

Vec3 clamp01(Vec3 color) {
  return min(max(color, {0, 0, 0}), {1, 1, 1});
}

Vec3 color_at(const SceneDesc& desc, Vec3 color, TextureId texture, const TexturePoint& point) {
  return texture.is_valid() ? color * texture_at(desc, texture, point).color : color;
}

float alpha_of(float roughness, Material::RoughnessScale scale) {
  roughness = min(max(roughness, 0.0f), 1.0f);
  switch (scale) {
    case Material::RoughnessScale::square_root_of_alpha:
      roughness *= roughness;
      break;
    case Material::RoughnessScale::square_of_alpha:
      roughness = std::sqrt(roughness);
      break;
    case Material::RoughnessScale::pbrt_3:
      if (roughness > 0) {
        // Version 3 of pbrt fits a polynomial of the logarithm.
        const float x = std::log(max(roughness, 1e-3f));
        roughness = 1.62142f + x * (0.819955f + x * (0.1734f + x * (0.0171201f + x * 0.000640711f)));
      }
      break;
    case Material::RoughnessScale::alpha:
      break;
  }
  return roughness >= kSmoothAlpha ? min(roughness, 1.0f) : 0;
}

}  // namespace

const Material& material_of(const SceneDesc& desc, MaterialId id) {
  static const Material kDefault;
  return id.is_valid() ? desc.materials[id.value] : kDefault;
}

Vec3 base_color(const SceneDesc& desc, const Material& material, const TexturePoint& point) {
  if (material.kind == Kind::mix) {
    const float share = mix_share(desc, material, point);
    return base_color(desc, material_of(desc, material.first), point) * (1 - share) +
           base_color(desc, material_of(desc, material.second), point) * share;
  }
  return clamp01(color_at(desc, material.color, material.color_texture, point));
}

Vec3 emission_at(const SceneDesc& desc, const Material& material, const TexturePoint& point) {
  return color_at(desc, material.emission, material.emission_texture, point);
}

float opacity_at(const SceneDesc& desc, const Material& material, const TexturePoint& point) {
  if (material.kind == Kind::clear) return 0;
  const float opacity = material.opacity * number_at(desc, material.opacity_texture, point);
  if (material.alpha_cutoff >= 0) return opacity >= material.alpha_cutoff ? 1 : 0;
  return min(max(opacity, 0.0f), 1.0f);
}

PreparedMaterial::PreparedMaterial(const Material& material)
    : is_emissive(render::is_emissive(material)),
      is_mix(material.kind == Kind::mix),
      is_see_through(render::is_see_through(material)),
      has_color_texture(material.color_texture.is_valid()),
      has_normal_texture(material.normal_texture.is_valid()),
      has_bumps(material.bump != 0 && material.bump_texture.texture.is_valid()),
      has_coat(material.kind == Kind::layered && material.coat > 0),
      is_plain(false),
      color(clamp01(material.color)),
      alpha(alpha_of(material.roughness, material.roughness_scale)),
      ior(material.ior >= 1 && material.ior < 10 ? material.ior : 1.5f),
      fresnel_mean(1 - (1 - internal_diffuse_reflectance(ior)) * ior * ior) {
  using Lobe = AlbedoTable::Lobe;
  // One row where the width is the same everywhere.
  const auto table = [](Lobe lobe, float eta, float alpha, bool is_varied) {
    if (alpha == 0 && !is_varied) return std::shared_ptr<const AlbedoTable>();
    return AlbedoTable::get(lobe, eta, is_varied ? -1 : alpha);
  };
  const bool is_varied = material.roughness_texture.texture.is_valid();
  const bool is_boundary_plain = material.kind == Kind::plastic && alpha > 0 && !is_varied && ior > 1;
  is_plain = material.kind == Kind::matte || is_boundary_plain;
  const bool is_layered = material.kind == Kind::layered;
  if (material.kind == Kind::metal || (is_layered && material.metalness > 0))
    reflection = table(Lobe::reflection, 1, alpha, is_varied);
  if (material.kind == Kind::plastic ||
      (is_layered && (material.metalness < 1 || material.metalness_texture.texture.is_valid())))
    coat_over_base = table(Lobe::coat, ior, alpha, is_varied);
  if (material.kind == Kind::glass || (is_layered && material.transmission > 0)) {
    // A pane only mirrors, to one side or the other.
    glass_outside = material.is_thin ? table(Lobe::reflection, 1, alpha, is_varied)
                                     : table(Lobe::glass, ior, alpha, is_varied);
    if (!material.is_thin) glass_inside = table(Lobe::glass, 1 / ior, alpha, is_varied);
  }
  if (has_coat)
    clear_coat = table(Lobe::coat, 1.5f,
                       alpha_of(material.coat_roughness, Material::RoughnessScale::square_root_of_alpha),
                       material.coat_roughness_texture.texture.is_valid());
  if (is_layered && max_component(material.sheen_color) > 0)
    sheen = table(Lobe::sheen, 1, max(material.sheen_roughness * material.sheen_roughness, kSmoothAlpha),
                  material.sheen_roughness_texture.texture.is_valid());
}

Look look_at(const SceneDesc& desc, const Material& m, const PreparedMaterial& prepared,
             const TexturePoint& point) {
  Look look{};
  look.kind = m.kind;
  look.prepared = &prepared;
  look.color = clamp01(color_at(desc, m.color, m.color_texture, point));
  look.ior = prepared.ior;
  if (m.kind == Kind::matte) return look;

  look.alpha = m.kind == Kind::mirror
                   ? 0
                   : alpha_of(m.roughness * number_at(desc, m.roughness_texture, point), m.roughness_scale);
  look.metal_eta = m.metal_eta;
  look.metal_k = m.metal_k;
  look.reflection_color = clamp01(m.reflection_color);
  look.transmission_color =
      clamp01(color_at(desc, m.transmission_color, m.transmission_color_texture, point));
  look.is_thin = m.is_thin;
  if (m.kind != Kind::layered) return look;

  const auto share = [&](float value, const NumberTexture& texture) {
    return min(max(value * number_at(desc, texture, point), 0.0f), 1.0f);
  };
  look.metalness = share(m.metalness, m.metalness_texture);
  look.transmission = share(m.transmission, m.transmission_texture);
  look.specular = share(m.specular, m.specular_texture);
  look.specular_color = color_at(desc, m.specular_color, m.specular_color_texture, point);
  look.coat = share(m.coat, m.coat_texture);
  look.coat_alpha = alpha_of(m.coat_roughness * number_at(desc, m.coat_roughness_texture, point),
                             Material::RoughnessScale::square_root_of_alpha);
  look.sheen_color = clamp01(color_at(desc, m.sheen_color, m.sheen_color_texture, point));
  const float sheen_roughness = share(m.sheen_roughness, m.sheen_roughness_texture);
  look.sheen_alpha = max(sheen_roughness * sheen_roughness, kSmoothAlpha);
  return look;
}

float mix_share(const SceneDesc& desc, const Material& mix, const TexturePoint& point) {
  return min(max(mix.mix_amount * number_at(desc, mix.mix_texture, point), 0.0f), 1.0f);
}

MaterialId choose_material(const SceneDesc& desc, MaterialId id, const TexturePoint& point, float choice) {
  // Mixes of mixes: what is left of the choice chooses again.
  while (id.is_valid() && desc.materials[id.value].kind == Kind::mix) {
    const Material& mix = desc.materials[id.value];
    const float share = mix_share(desc, mix, point);
    const bool is_second = choice < share;
    choice = is_second ? choice / share : (choice - share) / (1 - share);
    choice = min(choice, 0x1.fffffep-1f);
    id = is_second ? mix.second : mix.first;
  }
  return id;
}

}  // namespace boxwood::render
