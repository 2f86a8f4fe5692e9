#include "boxwood/io/pbrt_material.h"

#include <algorithm>
#include <cmath>

#include "boxwood/io/color.h"
#include "boxwood/io/pbrt_spectrum.h"

namespace boxwood::io::pbrt {
namespace {

using Kind = Material::Kind;

MaterialValue of_kind(Kind kind, const TextureValue& color) {
  MaterialValue value;
  value.material.kind = kind;
  value.material.color = color.color;
  value.material.color_texture = color.texture;
  return value;
}

/// What a boundary of the highest index that the renderer takes reflects head-on.
constexpr float kHighestHeadOn = 0.66f;

/// Gloss of which a boundary reflects only a share, by color or by the mean color of a picture; none makes
/// the surface matte.
void set_gloss(Material& plastic, const TextureValue& share) {
  const float most = std::min(max_component(share.color), 1.0f);
  if (!(most > 0)) {
    plastic.kind = Kind::matte;
  } else if (min_component(share.color) < 1 || !share.is_plain()) {
    plastic.kind = Kind::layered;
    plastic.specular = most;
    plastic.specular_color = share.color / max_component(share.color);
    plastic.specular_texture = {share.texture, NumberTexture::Channel::mean};
  }
}

/// Lets all light through unbent.
MaterialValue clear() {
  return of_kind(Kind::clear, {});
}

/// GGX alpha of a roughness in [0, 1].
/// Version 3 of pbrt fits a polynomial of the logarithm, version 4 takes the root.
float alpha_of_roughness(float roughness, bool is_version_3) {
  if (!(roughness > 0)) return 0;
  if (!is_version_3) return std::sqrt(roughness);
  const float x = std::log(std::max(roughness, 1e-3f));
  return 1.62142f + x * (0.819955f + x * (0.1734f + x * (0.0171201f + x * 0.000640711f)));
}

}  // namespace

Materials::Materials(Textures& textures, const Parser& parser, Warnings& warnings)
    : textures_(textures),
      parser_(parser),
      warnings_(warnings),
      values_{of_kind(Kind::matte, {{0.5f, 0.5f, 0.5f}, {}})} {}

int Materials::add(const Directive& directive) {
  MaterialValue value = evaluate(directive.strings[0], directive);
  set_relief(value.material, directive);
  values_.push_back(std::move(value));
  directive.parameters.warn_unused(directive.subject(), warnings_);
  return static_cast<int>(values_.size() - 1);
}

void Materials::define(const Directive& directive) {
  const std::string& name = directive.strings[0];
  const std::string kind = directive.parameters.string("type", "");
  if (kind.empty()) fail(directive.place, "MakeNamedMaterial " + in_quotes(name) + " has no \"string type\"");
  MaterialValue value = evaluate(kind, directive);
  set_relief(value.material, directive);
  directive.parameters.warn_unused("Material " + in_quotes(kind), warnings_);
  value.material.name = name;
  named_[name] = static_cast<int>(values_.size());
  values_.push_back(std::move(value));
}

void Materials::set_relief(Material& material, const Directive& directive) {
  // Version 3 says bumpmap, version 4 displacement; both bend normals only.
  for (const char* name : {"bumpmap", "displacement"}) {
    const NumberValue height = textures_.number_or_texture(directive.parameters, name, 0);
    if (!height.texture.texture.is_valid()) continue;
    material.bump = height.number;
    material.bump_texture = height.texture;
  }
  if (const std::string file = directive.parameters.string("normalmap", ""); !file.empty())
    material.normal_texture = material.coat_normal_texture = textures_.normal_map(file, directive.place);
}

int Materials::find(const std::string& name, const Place& place) const {
  const auto found = named_.find(name);
  if (found != named_.end()) return found->second;
  warnings_.once(place, "there is no material of the name " + in_quotes(name) + "; a grey one stands in");
  return 0;
}

void Materials::set_roughness(Material& material, const ParameterList& parameters, float otherwise,
                              bool is_version_3) const {
  const bool is_remapped = parameters.boolean("remaproughness", true);
  const Parameter* split = parameters.find("uroughness");
  if (split == nullptr) split = parameters.find("vroughness");

  // A texture is remapped where it is looked up.
  const NumberValue both = textures_.number_or_texture(parameters, "roughness", otherwise);
  const NumberValue along = textures_.number_or_texture(parameters, "uroughness", both.number),
                    across = textures_.number_or_texture(parameters, "vroughness", both.number);
  for (const NumberValue* value : {&along, &across, &both})
    if (value->texture.texture.is_valid()) {
      material.roughness = value->number;
      material.roughness_texture = value->texture;
      if (is_remapped)
        material.roughness_scale =
            is_version_3 ? Material::RoughnessScale::pbrt_3 : Material::RoughnessScale::square_of_alpha;
      return;
    }

  // Ours is the same in all directions: the geometric mean keeps the size of the highlight.
  const float u = along.number, v = across.number;
  const float alpha_u = is_remapped ? alpha_of_roughness(u, is_version_3) : u;
  const float alpha_v = is_remapped ? alpha_of_roughness(v, is_version_3) : v;
  if (u != v && split != nullptr)
    warnings_.once(split->place,
                   "roughness that differs between u and v is not supported; the mean stands in");
  const float alpha = alpha_u == alpha_v ? alpha_u : std::sqrt(std::max(alpha_u * alpha_v, 0.0f));
  material.roughness = std::min(std::max(alpha, 0.0f), 1.0f);
}

/// Measured constants, or a plain color.
void Materials::set_metal(Material& material, const ParameterList& parameters,
                          const std::string& prefix) const {
  if (parameters.find(prefix + "reflectance") != nullptr) {
    const TextureValue color = textures_.color(parameters, prefix + "reflectance", {{0.5f, 0.5f, 0.5f}, {}});
    material.color = color.color;
    material.color_texture = color.texture;
    return;
  }
  const Conductor& copper = default_conductor();
  material.color = {1, 1, 1};
  material.metal_eta = color_of(parameters, prefix + "eta", copper.eta, parser_, warnings_);
  material.metal_k = color_of(parameters, prefix + "k", copper.k, parser_, warnings_);
  // Without absorption it would be glass; a trace of it keeps the formula.
  material.metal_k = max(material.metal_k, splat(1e-3f));
}

MaterialValue Materials::mix(const Directive& directive) const {
  const ParameterList& parameters = directive.parameters;
  MaterialValue value;
  value.material.kind = Kind::mix;
  const NumberValue amount = textures_.number_or_texture(parameters, "amount", 0.5f);
  std::string first = parameters.string("namedmaterial1", ""),
              second = parameters.string("namedmaterial2", "");
  if (const Parameter* list = parameters.find("materials"); list != nullptr && list->strings.size() == 2) {
    // Version 4: the amount is the share of the second.
    first = list->strings[0];
    second = list->strings[1];
  } else {
    std::swap(first, second);  // version 3: of the first
  }
  value.first = find(first, directive.place);
  value.second = find(second, directive.place);
  value.material.mix_amount = amount.number;
  value.material.mix_texture = amount.texture;
  return value;
}

Vec3 Materials::metal_color(const ParameterList& parameters, const std::string& prefix) const {
  if (parameters.find(prefix + "reflectance") != nullptr)
    return textures_.plain_color(parameters, prefix + "reflectance", {0.5f, 0.5f, 0.5f});
  const Conductor& copper = default_conductor();
  return conductor_reflectance(color_of(parameters, prefix + "eta", copper.eta, parser_, warnings_),
                               color_of(parameters, prefix + "k", copper.k, parser_, warnings_));
}

MaterialValue Materials::evaluate(const std::string& kind, const Directive& directive) const {
  const ParameterList& parameters = directive.parameters;
  const auto color = [&](const char* name, float otherwise) {
    return textures_.color(parameters, name, {splat(otherwise), {}});
  };
  const auto warn = [&](const std::string& message) { warnings_.once(directive.place, message); };
  const auto stands_in = [&](const char* what) {
    warn("materials of the kind " + in_quotes(kind) + " are not supported; " + what + " stands in");
    for (const Parameter& parameter : parameters.all()) parameter.is_used = true;
  };
  const auto ior = [&](float otherwise) {
    float value = otherwise;
    for (const char* name : {"eta", "index"})
      if (const Parameter* parameter = parameters.find(name))
        value = parameter->type == "float" || parameter->type == "texture"
                    ? textures_.number(parameters, name, otherwise)
                    : color_of(*parameter, parser_, warnings_).value_or(splat(otherwise)).y;
    if (value >= 1 && value <= 10) return value;
    warn("an index of refraction of " + std::to_string(value) + " is not supported; " +
         std::to_string(otherwise) + " stands in");
    return otherwise;
  };

  // A coat over a colored base.
  const auto plastic = [&](const char* base, float base_default, float roughness_default, bool is_version_3) {
    MaterialValue value = of_kind(Kind::plastic, color(base, base_default));
    set_roughness(value.material, parameters, roughness_default, is_version_3);
    return value;
  };

  if (kind == "matte" || kind == "diffuse")
    return of_kind(Kind::matte, color(kind == "matte" ? "Kd" : "reflectance", 0.5f));
  if (kind == "plastic") {
    MaterialValue value = plastic("Kd", 0.25f, 0.1f, true);
    set_gloss(value.material, color("Ks", 0.25f));
    return value;
  }
  if (kind == "substrate") {
    // The color of the gloss is what it reflects head-on, and there is one index that reflects so much.
    MaterialValue value = plastic("Kd", 0.5f, 0.1f, true);
    const TextureValue given = color("Ks", 0.5f);
    const Vec3 gloss = given.is_plain() ? given.color : splat(0.04f);
    if (!given.is_plain())
      warn("a picture for the gloss (\"Ks\") of \"substrate\" is not supported; that of glass stands in");
    if (min_component(gloss) < max_component(gloss))
      warn("gloss (\"Ks\") of another color than grey is not supported in \"substrate\"; its mean stands in");
    const float root = std::sqrt(std::clamp((gloss.x + gloss.y + gloss.z) / 3, 0.0f, kHighestHeadOn));
    value.material.ior = (1 + root) / (1 - root);
    if (root == 0) value.material.kind = Kind::matte;
    return value;
  }
  if (kind == "coateddiffuse") {
    MaterialValue value = plastic("reflectance", 0.5f, 0, false);
    value.material.ior = ior(1.5f);
    parameters.ignore({"maxdepth", "nsamples", "thickness"});
    return value;
  }
  if (kind == "uber") return uber(directive, ior(1.5f));
  if (kind == "metal" || kind == "conductor") {
    MaterialValue value = of_kind(Kind::metal, {});
    set_metal(value.material, parameters, "");
    set_roughness(value.material, parameters, kind == "metal" ? 0.01f : 0, kind == "metal");
    return value;
  }
  if (kind == "coatedconductor") {
    MaterialValue value = of_kind(Kind::layered, {metal_color(parameters, "conductor."), {}});
    Material& m = value.material;
    m.metalness = 1;
    m.roughness = std::min(std::max(textures_.number(parameters, "conductor.roughness", 0), 0.0f), 1.0f);
    m.roughness_scale = Material::RoughnessScale::square_of_alpha;
    m.coat = 1;
    // Alpha is the root of pbrt's number, and the square of ours.
    m.coat_roughness =
        std::sqrt(std::sqrt(std::max(textures_.number(parameters, "interface.roughness", 0), 0.0f)));
    parameters.ignore({"interface.thickness", "maxdepth", "nsamples", "remaproughness", "conductor.eta",
                       "conductor.k", "reflectance"});
    return value;
  }
  if (kind == "mirror") return of_kind(Kind::mirror, color("Kr", 0.9f));
  if (kind == "glass" || kind == "dielectric" || kind == "thindielectric") {
    MaterialValue value = of_kind(Kind::glass, color("Kt", 1));
    value.material.reflection_color = textures_.plain_color(parameters, "Kr", {1, 1, 1});
    value.material.ior = ior(1.5f);
    value.material.is_thin = kind == "thindielectric";
    if (!value.material.is_thin) set_roughness(value.material, parameters, 0, kind == "glass");
    return value;
  }
  if (kind == "none" || kind == "interface" || kind.empty()) return clear();
  if (kind == "translucent" || kind == "diffusetransmission") {
    // Version 3 gives a color and two shares of it, version 4 gives both colors.
    const bool is_version_3 = kind == "translucent";
    MaterialValue value = of_kind(Kind::translucent, color(is_version_3 ? "Kd" : "reflectance", 0.25f));
    Material& m = value.material;
    if (is_version_3) {
      m.transmission_color = m.color * textures_.plain_color(parameters, "transmit", {0.5f, 0.5f, 0.5f});
      m.transmission_color_texture = m.color_texture;
      m.color = m.color * textures_.plain_color(parameters, "reflect", {0.5f, 0.5f, 0.5f});
      if (max_component(textures_.plain_color(parameters, "Ks", {0.25f, 0.25f, 0.25f})) > 0)
        warn("the gloss (\"Ks\") of \"translucent\" materials is not supported; they are matte");
      parameters.ignore({"roughness", "remaproughness"});
    } else {
      const TextureValue through = color("transmittance", 0.25f);
      const float scale = textures_.number(parameters, "scale", 1);
      m.transmission_color = through.color * scale;
      m.transmission_color_texture = through.texture;
      m.color *= scale;
    }
    return value;
  }
  if (kind == "mix") return mix(directive);
  if (kind == "disney") return disney(directive, ior(1.5f));

  // Whatever scatters light below its surface, and what is not known at all: matte, in the color that it
  // gives.
  const char* color_name = parameters.find("Kd") != nullptr      ? "Kd"
                           : parameters.find("color") != nullptr ? "color"
                                                                 : "reflectance";
  MaterialValue value = of_kind(Kind::matte, color(color_name, 0.5f));
  stands_in("a matte one");
  return value;
}

/// Version 3's material of many parts.
MaterialValue Materials::uber(const Directive& directive, float ior) const {
  const ParameterList& parameters = directive.parameters;
  const TextureValue opacity = textures_.color(parameters, "opacity", {});
  const Vec3 through = textures_.plain_color(parameters, "Kt", {0, 0, 0});
  const TextureValue gloss = textures_.color(parameters, "Ks", {splat(0.25f), {}});
  const bool is_shiny = max_component(textures_.plain_color(parameters, "Kr", {0, 0, 0})) > 0;
  MaterialValue value =
      of_kind(Kind::plastic, textures_.color(parameters, "Kd", {{0.25f, 0.25f, 0.25f}, {}}));
  Material& m = value.material;
  m.ior = ior;
  set_roughness(m, parameters, 0.1f, true);
  if (is_shiny) m.roughness = 0;
  set_gloss(m, is_shiny ? TextureValue{} : gloss);
  if (const float kt = max_component(through); kt > 0) {
    // What gets through, beside what is scattered.
    m.kind = Kind::layered;
    m.transmission = kt / (kt + max_component(m.color));
    m.color = m.color + through;
  }
  m.opacity = (opacity.color.x + opacity.color.y + opacity.color.z) / 3;
  m.opacity_texture = {opacity.texture, NumberTexture::Channel::mean};
  if (m.opacity <= 0) return clear();
  return value;
}

/// Burley's material, as far as our layers know its parts.
MaterialValue Materials::disney(const Directive& directive, float ior) const {
  const ParameterList& parameters = directive.parameters;
  MaterialValue value =
      of_kind(Kind::layered, textures_.color(parameters, "color", {{0.5f, 0.5f, 0.5f}, {}}));
  Material& m = value.material;
  const auto take = [&](const char* name, float otherwise, float& number, NumberTexture& texture) {
    const NumberValue found = textures_.number_or_texture(parameters, name, otherwise);
    number = found.number;
    texture = found.texture;
  };
  m.ior = ior;
  m.roughness_scale = Material::RoughnessScale::square_root_of_alpha;
  take("roughness", 0.5f, m.roughness, m.roughness_texture);
  take("metallic", 0, m.metalness, m.metalness_texture);
  take("spectrans", 0, m.transmission, m.transmission_texture);
  // Its coat is a quarter as strong as one of glass, and its gloss runs from 0.1 to 0.001.
  take("clearcoat", 0, m.coat, m.coat_texture);
  m.coat *= 0.25f;
  m.coat_roughness = std::sqrt(0.1f + (0.001f - 0.1f) * textures_.number(parameters, "clearcoatgloss", 1));
  m.sheen_color = splat(textures_.number(parameters, "sheen", 0));
  m.sheen_roughness = 0.5f;
  m.is_thin = parameters.boolean("thin", false);
  return value;
}

Coverage read_coverage(const Directive& shape, const Textures& textures) {
  if (shape.parameters.find("alpha") == nullptr) return {};
  return {true, textures.number_or_texture(shape.parameters, "alpha", 1)};
}

}  // namespace boxwood::io::pbrt
