#include "boxwood/io/gltf_material.h"

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "boxwood/io/gltf_accessor.h"
#include "boxwood/io/gltf_value.h"
#include "boxwood/io/picture_cache.h"

namespace boxwood::io::gltf {
namespace {

/// A texture as a material uses it.
struct TextureUse {
  int texture = -1;
  int uv_set = 0;
  const tinygltf::Value* transform = nullptr;  // KHR_texture_transform
};

/// The transform has the last word on the set of coordinates.
TextureUse use_of(int texture, int uv_set, const tinygltf::Value* transform) {
  return {texture, whole_number(transform, "texCoord", uv_set), transform};
}
TextureUse use_of(const auto& info) {
  return use_of(info.index, info.texCoord, extension(info.extensions, "KHR_texture_transform"));
}
TextureUse use_of(const tinygltf::Value* object, const char* name) {
  const tinygltf::Value* info = member(object, name);
  if (info == nullptr) return {};
  return use_of(whole_number(info, "index", -1), whole_number(info, "texCoord", 0),
                member(member(info, "extensions"), "KHR_texture_transform"));
}

constexpr const char* kSpecularGloss = "KHR_materials_pbrSpecularGlossiness";

/// Every texture of a material, whatever for; the base color's comes first.
std::vector<TextureUse> textures_of(const tinygltf::Material& m) {
  std::vector<TextureUse> uses = {use_of(m.pbrMetallicRoughness.baseColorTexture),
                                  use_of(extension(m.extensions, kSpecularGloss), "diffuseTexture"),
                                  use_of(m.pbrMetallicRoughness.metallicRoughnessTexture),
                                  use_of(m.normalTexture), use_of(m.emissiveTexture)};
  constexpr std::pair<const char*, const char*> kOthers[] = {
      {"KHR_materials_transmission", "transmissionTexture"},
      {"KHR_materials_clearcoat", "clearcoatTexture"},
      {"KHR_materials_clearcoat", "clearcoatRoughnessTexture"},
      {"KHR_materials_clearcoat", "clearcoatNormalTexture"},
      {"KHR_materials_sheen", "sheenColorTexture"},
      {"KHR_materials_sheen", "sheenRoughnessTexture"},
      {"KHR_materials_specular", "specularTexture"},
      {"KHR_materials_specular", "specularColorTexture"}};
  for (const auto& [extension_name, name] : kOthers)
    uses.push_back(use_of(extension(m.extensions, extension_name), name));
  return uses;
}

UvSets uv_sets_of(const tinygltf::Material& material) {
  UvSets sets;
  bool is_first = true;
  for (const TextureUse& use : textures_of(material)) {
    if (use.texture < 0) continue;
    if (is_first)
      sets.first = use.uv_set;
    else if (use.uv_set != sets.first && !sets.second)
      sets.second = use.uv_set;
    is_first = false;
  }
  return sets;
}

/// The picture behind a texture, or -1.
int image_of(const File& file, int texture) {
  const auto& textures = file.model->textures;
  if (texture < 0 || std::size_t(texture) >= textures.size()) return -1;
  const int image = whole_number(extension(textures[texture].extensions, "EXT_texture_webp"), "source",
                                 textures[texture].source);
  return image >= 0 && std::size_t(image) < file.model->images.size() ? image : -1;
}

Texture read_picture(const File& file, int index) {
  const tinygltf::Image& image = file.model->images[index];
  const std::string where = "image " + std::to_string(index);
  std::string name = !image.name.empty() ? image.name : where;
  if (image.bufferView >= 0) return open_texture(view_bytes(file, image.bufferView, where), name);
  if (image.image.empty()) file.fail(where, "there is no file " + image.uri.substr(0, 100));
  return open_texture(std::as_bytes(std::span(image.image)), name);
}

/// Every picture that the materials use, decoded in parallel; a broken one is empty and named in a warning.
std::map<int, Texture> read_pictures(const File& file, Executor& executor,
                                     std::vector<std::string>& warnings) {
  std::map<int, Texture> pictures;
  for (const tinygltf::Material& material : file.model->materials)
    for (const TextureUse& use : textures_of(material))
      if (const int image = image_of(file, use.texture); image >= 0) pictures.try_emplace(image);

  std::vector<std::pair<const int, Texture>*> slots;
  for (auto& entry : pictures) slots.push_back(&entry);
  std::vector<std::string> errors(slots.size());
  parallel_for(executor, 0, slots.size(), 1, [&](std::size_t i) {
    try {
      slots[i]->second = read_picture(file, slots[i]->first);
    } catch (const std::exception& error) {
      errors[i] = error.what();
    }
  });
  for (std::size_t i = 0; i < slots.size(); ++i)
    if (!errors[i].empty())
      warn(warnings, file, "image " + std::to_string(slots[i]->first),
           "the picture cannot be read (" + errors[i] + "); plain color stands in");
  return pictures;
}

Texture::Wrap wrap_of(int code) {
  if (code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Texture::Wrap::clamp;
  if (code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Texture::Wrap::mirror;
  return Texture::Wrap::repeat;
}

class MaterialMaker {
 public:
  MaterialMaker(const File& file, Executor& executor, SceneDesc& desc)
      : file_(file), desc_(desc), pictures_(read_pictures(file, executor, desc.warnings)) {}

  /// `is_colored`: vertices have colors where it is used.
  Material make(const tinygltf::Material& source, const std::string& where, bool is_colored) {
    uv_sets_ = uv_sets_of(source);
    where_ = where;
    Material m;
    m.name = source.name;
    m.kind = Material::Kind::layered;
    m.roughness_scale = Material::RoughnessScale::square_root_of_alpha;
    take_base(source, m, is_colored);
    if (source.extensions.count("KHR_materials_unlit") != 0) {
      show_unlit(m);
      return m;
    }
    take_emission(source, m);
    take_layers(source.extensions, m);
    take_inside(source.extensions, m);
    if (const tinygltf::Value* gloss = extension(source.extensions, kSpecularGloss);
        gloss && !has_metalness(source))
      take_specular_gloss(source, *gloss, m, is_colored);
    return m;
  }

 private:
  using Channel = NumberTexture::Channel;

  /// Base color, metalness, roughness, opacity and normals: what every material has.
  void take_base(const tinygltf::Material& source, Material& m, bool is_colored) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    m.color = color_of(pbr.baseColorFactor, {1, 1, 1});
    if (const TextureUse use = use_of(pbr.baseColorTexture); use.texture >= 0) {
      m.color_texture = texture_id(use, true);
      if (!m.color_texture.is_valid()) m.color *= 0.5f;
    }
    if (is_colored) m.color_texture = times_vertex_colors(m.color_texture);
    m.metalness = clamp01(pbr.metallicFactor);
    m.roughness = clamp01(pbr.roughnessFactor);
    const TextureId rough_metal = texture_id(use_of(pbr.metallicRoughnessTexture), false);
    m.roughness_texture = {rough_metal, Channel::green};
    m.metalness_texture = {rough_metal, Channel::blue};
    m.normal_texture = texture_id(use_of(source.normalTexture), false);
    m.normal_scale = static_cast<float>(source.normalTexture.scale);

    take_opacity(source, pbr.baseColorFactor.size() == 4 ? pbr.baseColorFactor[3] : 1, m);
  }

  /// Opacity is the alpha of the base color, where the material says that it counts.
  static void take_opacity(const tinygltf::Material& source, double alpha, Material& m) {
    if (source.alphaMode != "MASK" && source.alphaMode != "BLEND") return;
    m.opacity = clamp01(alpha);
    m.opacity_texture = {m.color_texture, Channel::alpha};
    if (source.alphaMode == "MASK") m.alpha_cutoff = static_cast<float>(std::fmax(source.alphaCutoff, 0));
  }

  /// Shows its color whatever the light is: black, and glowing so.
  static void show_unlit(Material& m) {
    m.kind = Material::Kind::matte;
    m.emission = m.color;
    m.emission_texture = m.color_texture;
    m.emits_from_both_sides = true;
    m.color = {0, 0, 0};
    m.color_texture = m.normal_texture = {};
    m.roughness_texture = m.metalness_texture = {};
  }

  void take_emission(const tinygltf::Material& source, Material& m) {
    m.emission = color_of(source.emissiveFactor, {0, 0, 0}) *
                 static_cast<float>(number(extension(source.extensions, "KHR_materials_emissive_strength"),
                                           "emissiveStrength", 1));
    if (!is_finite(m.emission) || min_component(m.emission) < 0)
      file_.fail(where_, "the emission is not a finite color");
    m.emits_from_both_sides = source.doubleSided;
    if (max_component(m.emission) > 0) m.emission_texture = texture_id(use_of(source.emissiveTexture), true);
  }

  /// Coat, sheen and the strength of the reflection.
  void take_layers(const Extensions& extensions, Material& m) {
    const tinygltf::Value* specular = extension(extensions, "KHR_materials_specular");
    m.specular = clamp01(number(specular, "specularFactor", 1));
    m.specular_texture = {texture_id(use_of(specular, "specularTexture"), false), Channel::alpha};
    m.specular_color = color(specular, "specularColorFactor", {1, 1, 1});
    m.specular_color_texture = texture_id(use_of(specular, "specularColorTexture"), true);

    const tinygltf::Value* coat = extension(extensions, "KHR_materials_clearcoat");
    m.coat = clamp01(number(coat, "clearcoatFactor", 0));
    m.coat_texture = {texture_id(use_of(coat, "clearcoatTexture"), false), Channel::red};
    m.coat_roughness = clamp01(number(coat, "clearcoatRoughnessFactor", 0));
    m.coat_roughness_texture = {texture_id(use_of(coat, "clearcoatRoughnessTexture"), false), Channel::green};
    m.coat_normal_texture = texture_id(use_of(coat, "clearcoatNormalTexture"), false);
    m.coat_normal_scale = static_cast<float>(number(member(coat, "clearcoatNormalTexture"), "scale", 1));

    const tinygltf::Value* sheen = extension(extensions, "KHR_materials_sheen");
    m.sheen_color = color(sheen, "sheenColorFactor", {0, 0, 0});
    m.sheen_color_texture = texture_id(use_of(sheen, "sheenColorTexture"), true);
    m.sheen_roughness = clamp01(number(sheen, "sheenRoughnessFactor", 0));
    m.sheen_roughness_texture = {texture_id(use_of(sheen, "sheenRoughnessTexture"), false), Channel::alpha};
  }

  /// Most files of that kind say the same a second time, in the format's own way.
  static bool has_metalness(const tinygltf::Material& source) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    return pbr.baseColorTexture.index >= 0 || pbr.metallicRoughnessTexture.index >= 0 ||
           pbr.metallicFactor != 1 || pbr.roughnessFactor != 1 ||
           color_of(pbr.baseColorFactor, {1, 1, 1}) != Vec3{1, 1, 1};
  }

  /// A matte color below a boundary that reflects so much of each color head-on; or metal, where there is
  /// nothing below.
  void take_specular_gloss(const tinygltf::Material& source, const tinygltf::Value& gloss, Material& m,
                           bool is_colored) {
    constexpr float kBlack = 0.04f, kHighestHeadOn = 0.66f;  // of the highest index that the renderer takes
    const Vec3 specular = min(color(&gloss, "specularFactor", {1, 1, 1}), {1, 1, 1});
    const float most = max_component(specular);
    const TextureUse picture = use_of(&gloss, "diffuseTexture");
    m.color = color(&gloss, "diffuseFactor", {1, 1, 1});
    m.color_texture = texture_id(picture, true);
    if (picture.texture >= 0 && !m.color_texture.is_valid()) m.color *= 0.5f;
    m.metalness = picture.texture < 0 && max_component(m.color) <= kBlack && most > kBlack ? 1.0f : 0.0f;
    if (m.metalness > 0) m.color = specular;
    if (is_colored) m.color_texture = times_vertex_colors(m.color_texture);
    const tinygltf::Value* diffuse = member(&gloss, "diffuseFactor");
    const bool has_alpha = diffuse != nullptr && diffuse->IsArray() && diffuse->ArrayLen() == 4;
    take_opacity(source, has_alpha && diffuse->Get(3).IsNumber() ? diffuse->Get(3).GetNumberAsDouble() : 1,
                 m);
    m.roughness = 1 - clamp01(number(&gloss, "glossinessFactor", 1));
    m.specular = most > 0 ? 1 : 0;
    m.specular_color = most > 0 ? specular / most : specular;
    const float root = std::sqrt(std::fmin(most, kHighestHeadOn));
    if (most > 0) m.ior = (1 + root) / (1 - root);
    if (member(&gloss, "specularGlossinessTexture") != nullptr) {
      // The picture may turn every part of it into something else; what is most common stands in.
      m.metalness = 0;
      m.specular = 1;
      m.specular_color = {1, 1, 1};
      m.ior = 1.5f;
      m.roughness = 0.5f;
      warn(desc_.warnings, file_, "",
           "pictures of gloss (specularGlossinessTexture) are not supported; plastic stands in");
    }
  }

  /// What gets through, and what the inside takes away.
  void take_inside(const Extensions& extensions, Material& m) {
    m.ior = static_cast<float>(number(extension(extensions, "KHR_materials_ior"), "ior", 1.5));
    if (!(m.ior >= 1 && m.ior < 10)) m.ior = 1.5f;
    const tinygltf::Value* transmission = extension(extensions, "KHR_materials_transmission");
    m.transmission = clamp01(number(transmission, "transmissionFactor", 0));
    m.transmission_texture = {texture_id(use_of(transmission, "transmissionTexture"), false), Channel::red};

    // Without a thickness the surface is a pane.
    const tinygltf::Value* volume = extension(extensions, "KHR_materials_volume");
    m.is_thin = !(number(volume, "thicknessFactor", 0) > 0);
    const double distance = number(volume, "attenuationDistance", 0);
    if (m.is_thin || !(distance > 0)) return;
    const Vec3 left = color(volume, "attenuationColor", {1, 1, 1});
    const auto absorption = [&](float share) {
      return static_cast<float>(-std::log(std::fmin(std::fmax(share, 1e-6), 1)) / distance);
    };
    m.absorption = {absorption(left.x), absorption(left.y), absorption(left.z)};
    if (!is_finite(m.absorption)) m.absorption = {0, 0, 0};
  }

  const Texture* find(int image) const {
    const auto found = pictures_.find(image);
    return found != pictures_.end() && found->second.width > 0 ? &found->second : nullptr;
  }

  /// The scene's texture for one way of using a picture; each is there once. None, with a warning, where
  /// there is no picture.
  TextureId texture_id(const TextureUse& use, bool is_color) {
    if (use.texture < 0) return {};
    const int image = image_of(file_, use.texture);
    const Texture* picture = find(image);
    if (picture == nullptr) {
      if (image < 0)
        warn(desc_.warnings, file_, where_, "a texture leads to no picture; plain color stands in");
      return {};
    }
    Texture placed;
    placed.is_by_second_uvs = uv_sets_.second == use.uv_set;
    if (use.uv_set != uv_sets_.first && !placed.is_by_second_uvs)
      warn(desc_.warnings, file_, where_,
           "more than two sets of texture coordinates are not supported; the first stands in for the third");
    const int sampler = file_.model->textures[use.texture].sampler;
    if (sampler >= 0 && std::size_t(sampler) < file_.model->samplers.size()) {
      placed.wrap_u = wrap_of(file_.model->samplers[sampler].wrapS);
      placed.wrap_v = wrap_of(file_.model->samplers[sampler].wrapT);
      placed.is_mixed = file_.model->samplers[sampler].magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    move_by(use.transform, placed);
    const auto [entry, is_new] =
        ids_.try_emplace({image, is_color, placed.is_by_second_uvs, placed.is_mixed, int(placed.wrap_u),
                          int(placed.wrap_v), placed.u_axis.x, placed.u_axis.y, placed.v_axis.x,
                          placed.v_axis.y, placed.offset.x, placed.offset.y});
    if (!is_new) return entry->second;
    placed.name = picture->name;
    placed.width = picture->width;
    placed.height = picture->height;
    placed.texels = picture->texels;
    placed.source = picture->source;
    placed.is_srgb = is_color && picture->is_srgb;  // numbers never are
    return entry->second = desc_.add(std::move(placed));
  }

  TextureId times_vertex_colors(TextureId picture) {
    if (!vertex_colors_.is_valid()) {
      Texture colors;
      colors.kind = Texture::Kind::vertex_color;
      colors.name = "colors of vertices";
      vertex_colors_ = desc_.add(std::move(colors));
    }
    if (!picture.is_valid()) return vertex_colors_;
    Texture product;
    product.kind = Texture::Kind::product;
    product.name = desc_.textures[picture.value].name;
    product.first.texture = picture;
    product.second.texture = vertex_colors_;
    return desc_.add(std::move(product));
  }

  /// KHR_texture_transform: scale, turn, then move, in coordinates whose v points down; ours points up.
  static void move_by(const tinygltf::Value* transform, Texture& texture) {
    if (transform == nullptr) return;
    const auto [x, y, unused] = numbers(transform, "offset", {0, 0, 0}, 2);
    const auto [wide, high, unused_too] = numbers(transform, "scale", {1, 1, 0}, 2);
    const double angle = number(transform, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
    texture.u_axis = {float(c * wide), float(s * wide)};
    texture.v_axis = {float(-s * high), float(c * high)};
    texture.offset = {float(s * high + x), float(1 - c * high - y)};
  }

  const File& file_;
  SceneDesc& desc_;
  std::map<int, Texture> pictures_;
  std::map<std::tuple<int, bool, bool, bool, int, int, float, float, float, float, float, float>, TextureId>
      ids_;
  TextureId vertex_colors_;
  UvSets uv_sets_;     // of the material that is being made
  std::string where_;  // its place, for messages
};

}  // namespace

void add_materials(const File& file, Executor& executor, SceneDesc& desc) {
  MaterialMaker maker(file, executor, desc);
  const auto& materials = file.model->materials;
  constexpr int kNone = -1;
  std::set<int> used, colored;
  for (const tinygltf::Mesh& mesh : file.model->meshes)
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      const int id = std::max(primitive.material, kNone);
      used.insert(id);
      if (primitive.attributes.count("COLOR_0") != 0) colored.insert(id);
    }
  desc.is_lit_by_glow = false;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const int id = static_cast<int>(i);
    const MaterialId added =
        desc.add(maker.make(materials[i], "material " + std::to_string(i), colored.count(id) != 0));
    // What is no brighter than white is there to be seen; lamps need KHR_materials_emissive_strength.
    if (used.count(id) != 0 && max_component(desc.materials[added.value].emission) > 1)
      desc.is_lit_by_glow = true;
  }
  if (used.count(kNone) != 0) desc.add(maker.make({}, "no material", colored.count(kNone) != 0));
}

UvSets uv_sets(const File& file, int material) {
  const auto& materials = file.model->materials;
  return material >= 0 && std::size_t(material) < materials.size() ? uv_sets_of(materials[material])
                                                                   : UvSets{};
}

}  // namespace boxwood::io::gltf
