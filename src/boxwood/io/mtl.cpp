#include "boxwood/io/mtl.h"

#include <sstream>
#include <utility>
#include <vector>

#include <tiny_obj_loader.h>

#include "boxwood/core/error.h"
#include "boxwood/io/file_bytes.h"
#include "boxwood/io/picture_cache.h"

namespace boxwood::io {
namespace {

// A color of the file; components that are no finite numbers count as 0.
Vec3 to_color(const tinyobj::real_t (&c)[3]) {
  const auto clean = [](float x) { return std::isfinite(x) && x > 0 ? x : 0.0f; };
  return {clean(c[0]), clean(c[1]), clean(c[2])};
}

bool is_black(Vec3 color) {
  return max_component(color) <= 0;
}

// The GGX alpha that is about as wide as a Blinn-Phong lobe of this exponent: Walter et al., "Microfacet
// Models for Refraction through Rough Surfaces", EGSR 2007, section 5.3 (exponent = 2 / alpha^2 - 2).
float roughness_of(float exponent) {
  if (!(exponent > 0)) return 1;
  return min(1.0f, std::sqrt(2 / (exponent + 2)));
}

// MTL describes light models of 1992 rather than surfaces;
// this picks the kind of surface that its words fit best.
Material to_material(const tinyobj::material_t& source) {
  const Vec3 diffuse = to_color(source.diffuse), specular = to_color(source.specular);
  const bool has_reflections = source.illum >= 3 && source.illum <= 9;
  const bool is_glass = source.illum == 4 || source.illum == 6 || source.illum == 7 || source.illum == 9;
  const bool is_textured = !source.diffuse_texname.empty();

  Material material;
  material.name = source.name;
  material.emission = to_color(source.emission);
  material.color = is_textured && is_black(diffuse) ? Vec3{1, 1, 1} : diffuse;
  if (source.ior > 1 && std::isfinite(source.ior)) material.ior = source.ior;

  // The PBR extension's words are the clearest; then what lets light through; then what only reflects.
  if (source.metallic >= 0.5f) {
    material.kind = Material::Kind::metal;
    material.roughness = min(1.0f, max(0.0f, source.roughness * source.roughness));
  } else if (is_glass || source.dissolve < 0.5f) {
    material.kind = Material::Kind::glass;
    const Vec3 filter = to_color(source.transmittance);
    material.color = is_black(filter) ? Vec3{1, 1, 1} : filter;
  } else if (!is_black(specular) && is_black(diffuse) && !is_textured) {
    material.kind = has_reflections ? Material::Kind::mirror : Material::Kind::metal;
    material.color = specular;
    material.roughness = has_reflections ? 0 : roughness_of(source.shininess);
  } else if (!is_black(specular) && source.illum >= 2) {
    material.kind = Material::Kind::plastic;
    material.roughness = roughness_of(source.shininess);
  }
  return material;
}

}  // namespace

void load_mtl(const std::filesystem::path& path, SceneDesc& desc, std::map<std::string, MaterialId>& ids) {
  std::vector<tinyobj::material_t> materials;
  try {
    std::istringstream stream(std::string(without_byte_order_mark(read_file(path))));
    std::map<std::string, int> names;
    std::string warning, error;
    tinyobj::LoadMtl(&names, &materials, &stream, &warning, &error);
  } catch (const std::exception& error) {
    desc.warnings.push_back(std::string("materials are left out: ") + error.what());
    return;
  }

  std::map<std::pair<std::string, bool>, TextureId> textures;
  const auto texture = [&](std::string name, bool is_color) {
    for (char& c : name)
      if (c == '\\') c = '/';
    const auto [found, is_new] = textures.try_emplace({name, is_color});
    if (is_new) {
      try {
        Texture picture = open_texture(path.parent_path() / name);
        picture.is_srgb = picture.is_srgb && is_color;
        found->second = desc.add(std::move(picture));
      } catch (const FileError& error) {
        desc.warnings.push_back(std::string("a texture is left out: ") + error.what());
      }
    }
    return found->second;
  };
  for (const tinyobj::material_t& source : materials) {
    Material material = to_material(source);
    if (!source.diffuse_texname.empty()) material.color_texture = texture(source.diffuse_texname, true);
    // Leaves and fences are cut out by the alpha of their own picture, or by a picture of greys.
    if (!source.alpha_texname.empty())
      material.opacity_texture = source.alpha_texname == source.diffuse_texname
                                     ? NumberTexture{material.color_texture, NumberTexture::Channel::alpha}
                                     : NumberTexture{texture(source.alpha_texname, false)};
    ids[source.name] = desc.add(std::move(material));
  }
}

}  // namespace boxwood::io
