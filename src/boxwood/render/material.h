// material.h: what is a surface made of, at a point of it?
//
// A Material speaks of a whole surface, with textures; a Look is what is left of it at one point, when all
// textures have been looked up. A PreparedMaterial is what can be worked out once for all points.
#pragma once

#include <vector>

#include "boxwood/render/albedo_table.h"
#include "boxwood/render/texture.h"

namespace boxwood::render {

/// The material that `id` names; grey and matte for none.
const Material& material_of(const SceneDesc& desc, MaterialId id);

/// The material's color times its texture, kept within [0, 1]: no surface reflects more than it gets.
Vec3 base_color(const SceneDesc& desc, const Material& material, const TexturePoint& point);

/// The radiance that the front side sends out.
Vec3 emission_at(const SceneDesc& desc, const Material& material, const TexturePoint& point);

/// The share of light that meets the surface; the rest goes straight on.
float opacity_at(const SceneDesc& desc, const Material& material, const TexturePoint& point);

inline bool is_emissive(const Material& material) {
  return max_component(material.emission) > 0;
}

/// Whether light may go straight through some of it.
inline bool is_see_through(const Material& material) {
  return material.kind == Material::Kind::clear || material.opacity < 1 ||
         material.opacity_texture.texture.is_valid();
}

/// What of a material does not depend on the place.
struct PreparedMaterial {
  explicit PreparedMaterial(const Material& material);

  bool is_emissive, is_mix, is_see_through, has_color_texture, has_normal_texture, has_bumps, has_coat;
  /// Plain: a matte base, bare or under a clear boundary whose roughness is the same everywhere and above 0.
  /// What most surfaces are (plain_block.h).
  bool is_plain;
  Vec3 color;   ///< Of the base, where it has no texture.
  float alpha;  ///< GGX width, where it is the same everywhere.
  float ior;
  float fresnel_mean;  ///< Of a smooth boundary from outside, over a hemisphere of equal light.
  /// For every width that the material has; null where it has no such lobe.
  std::shared_ptr<const AlbedoTable> reflection, coat_over_base, clear_coat, glass_outside, glass_inside,
      sheen;
};

/// A material at a point.
struct Look {
  Material::Kind kind;
  Vec3 color;
  float alpha;  ///< GGX width; 0 where the reflection is perfect.
  float ior;
  Vec3 metal_eta, metal_k;
  Vec3 reflection_color, transmission_color;
  bool is_thin;
  float metalness, transmission, specular;
  Vec3 specular_color;
  float coat, coat_alpha;
  Vec3 sheen_color;
  float sheen_alpha;
  const PreparedMaterial* prepared;
};

/// Looks up all textures of `material`, which is not a mix. `prepared` must outlive the result.
Look look_at(const SceneDesc& desc, const Material& material, const PreparedMaterial& prepared,
             const TexturePoint& point);

/// The share of the second of a mix's two materials.
float mix_share(const SceneDesc& desc, const Material& mix, const TexturePoint& point);

/// Follows mixes down to the material that `choice` picks, uniform in [0, 1).
MaterialId choose_material(const SceneDesc& desc, MaterialId id, const TexturePoint& point, float choice);

}  // namespace boxwood::render
