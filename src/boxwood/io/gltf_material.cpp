#include "boxwood/io/gltf_material.h"

#include <cmath>
#include <map>

#include <tiny_gltf.h>

#include "boxwood/io/color.h"
#include "boxwood/io/gltf_accessor.h"
#include "boxwood/io/image.h"

namespace boxwood::io::gltf {
namespace {

Vec3 color_of(const std::vector<double>& numbers, Vec3 otherwise) {
  if (numbers.size() < 3) return otherwise;
  const Vec3 color{float(numbers[0]), float(numbers[1]), float(numbers[2])};
  return is_finite(color) ? max(color, Vec3{0, 0, 0}) : otherwise;
}

float clamp01(double value) {
  return static_cast<float>(std::fmin(std::fmax(value, 0), 1));
}

/// A number of a material's extension, or `otherwise`.
double extension_number(const tinygltf::Material& material, const char* extension, const char* name,
                        double otherwise) {
  const auto found = material.extensions.find(extension);
  if (found == material.extensions.end() || !found->second.IsObject() || !found->second.Has(name))
    return otherwise;
  const tinygltf::Value& value = found->second.Get(std::string(name));
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

/// The picture behind a texture, or -1.
int image_of(const File& file, int texture) {
  const auto& textures = file.model->textures;
  if (texture < 0 || std::size_t(texture) >= textures.size()) return -1;
  const int image = textures[texture].source;
  return image >= 0 && std::size_t(image) < file.model->images.size() ? image : -1;
}

Texture read_picture(const File& file, int index) {
  const tinygltf::Image& image = file.model->images[index];
  const std::string where = "image " + std::to_string(index);
  std::string name = !image.name.empty() ? image.name : where;
  if (image.bufferView >= 0) return read_texture(view_bytes(file, image.bufferView, where), name);
  if (image.image.empty()) file.fail(where, "there is no file " + image.uri.substr(0, 100));
  return read_texture(std::as_bytes(std::span(image.image)), name);
}

/// Every picture that the materials use, decoded in parallel; a broken one is empty and named in a warning.
std::map<int, Texture> read_pictures(const File& file, Executor& executor,
                                     std::vector<std::string>& warnings) {
  std::map<int, Texture> pictures;
  for (const tinygltf::Material& material : file.model->materials)
    for (const int texture :
         {material.pbrMetallicRoughness.baseColorTexture.index,
          material.pbrMetallicRoughness.metallicRoughnessTexture.index, material.emissiveTexture.index})
      if (const int image = image_of(file, texture); image >= 0) pictures.try_emplace(image);

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

class MaterialMaker {
 public:
  MaterialMaker(const File& file, Executor& executor, SceneDesc& desc)
      : file_(file), desc_(desc), pictures_(read_pictures(file, executor, desc.warnings)) {}

  Material make(const tinygltf::Material& source, const std::string& where) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    Material material;
    material.name = source.name;
    material.color = color_of(pbr.baseColorFactor, {1, 1, 1});
    if (pbr.baseColorTexture.index >= 0) {
      material.color_texture = texture_id(image_of(file_, pbr.baseColorTexture.index), where);
      if (!material.color_texture.is_valid()) material.color *= 0.5f;
    }

    // Metalness and roughness; a picture of them counts by its mean.
    double metallic = pbr.metallicFactor, roughness = pbr.roughnessFactor;
    if (const Texture* picture = find(image_of(file_, pbr.metallicRoughnessTexture.index))) {
      Texture linear = *picture;
      linear.is_srgb = false;
      const Vec3 mean = average_color(linear);
      roughness *= mean.y;
      metallic *= mean.z;
      warn(desc_.warnings, file_, "",
           "pictures of metalness and roughness are not supported; their means stand in");
    }
    material.ior = static_cast<float>(extension_number(source, "KHR_materials_ior", "ior", 1.5));
    if (!(material.ior >= 1 && material.ior <= 10)) material.ior = 1.5f;
    const float alpha = clamp01(roughness) * clamp01(roughness);
    constexpr double kShines = 0.7;  // above this roughness a coat's highlight cannot be told from the base
    if (extension_number(source, "KHR_materials_transmission", "transmissionFactor", 0) > 0.5)
      material.kind = Material::Kind::glass;
    else if (metallic > 0.5)
      material.kind = Material::Kind::metal;
    else
      material.kind = roughness < kShines ? Material::Kind::plastic : Material::Kind::matte;
    material.roughness =
        material.kind == Material::Kind::metal || material.kind == Material::Kind::plastic ? alpha : 0;

    // What it sends out itself.
    material.emission = color_of(source.emissiveFactor, {0, 0, 0}) *
                        static_cast<float>(extension_number(source, "KHR_materials_emissive_strength",
                                                            "emissiveStrength", 1));
    if (const Texture* picture = find(image_of(file_, source.emissiveTexture.index));
        picture != nullptr && max_component(material.emission) > 0) {
      material.emission = material.emission * average_color(*picture);
      warn(desc_.warnings, file_, "", "pictures of emission are not supported; their means stand in");
    }
    if (!is_finite(material.emission) || min_component(material.emission) < 0)
      file_.fail(where, "the emission is not a finite color");
    material.emits_from_both_sides = source.doubleSided;

    // Say what is lost.
    if (source.normalTexture.index >= 0)
      warn(desc_.warnings, file_, "", "normal maps are not supported and left out");
    if (!source.alphaMode.empty() && source.alphaMode != "OPAQUE")
      warn(desc_.warnings, file_, "",
           "transparency by alpha (" + source.alphaMode.substr(0, 20) + ") is not supported; it is opaque");
    return material;
  }

 private:
  const Texture* find(int image) const {
    const auto found = pictures_.find(image);
    return found != pictures_.end() && !found->second.texels.empty() ? &found->second : nullptr;
  }

  /// The texture of a picture in the scene; each picture is there once.
  TextureId texture_id(int image, const std::string& where) {
    const Texture* picture = find(image);
    if (picture == nullptr) {
      if (image < 0)
        warn(desc_.warnings, file_, where,
             "the base color's texture leads to no picture; plain grey stands in");
      return {};
    }
    const auto [entry, is_new] = ids_.try_emplace(image);
    if (is_new) {
      Texture texture = *picture;
      texture.is_srgb = true;  // base colors always are
      entry->second = desc_.add(std::move(texture));
    }
    return entry->second;
  }

  const File& file_;
  SceneDesc& desc_;
  std::map<int, Texture> pictures_;
  std::map<int, TextureId> ids_;
};

}  // namespace

void add_materials(const File& file, Executor& executor, SceneDesc& desc) {
  MaterialMaker maker(file, executor, desc);
  const auto& materials = file.model->materials;
  for (std::size_t i = 0; i < materials.size(); ++i)
    desc.add(maker.make(materials[i], "material " + std::to_string(i)));
}

int base_color_uv_set(const File& file, int material) {
  const auto& materials = file.model->materials;
  if (material < 0 || std::size_t(material) >= materials.size()) return 0;
  return materials[material].pbrMetallicRoughness.baseColorTexture.texCoord;
}

}  // namespace boxwood::io::gltf
