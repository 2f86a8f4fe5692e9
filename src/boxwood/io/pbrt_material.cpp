#include "boxwood/io/pbrt_material.h"

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
  value.picture = color.picture;
  return value;
}

/// Lets all light through unbent: glass that is no denser than air.
MaterialValue clear() {
  MaterialValue value = of_kind(Kind::glass, {});
  value.material.ior = 1;
  return value;
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

Materials::Materials(const Textures& textures, const Parser& parser, Warnings& warnings)
    : textures_(textures),
      parser_(parser),
      warnings_(warnings),
      values_{of_kind(Kind::matte, {{0.5f, 0.5f, 0.5f}, -1})} {}

int Materials::add(const Directive& directive) {
  values_.push_back(evaluate(directive.strings[0], directive));
  directive.parameters.warn_unused(directive.subject(), warnings_);
  return static_cast<int>(values_.size() - 1);
}

void Materials::define(const Directive& directive) {
  const std::string& name = directive.strings[0];
  const std::string kind = directive.parameters.string("type", "");
  if (kind.empty()) fail(directive.place, "MakeNamedMaterial " + in_quotes(name) + " has no \"string type\"");
  MaterialValue value = evaluate(kind, directive);
  directive.parameters.warn_unused("Material " + in_quotes(kind), warnings_);
  value.material.name = name;
  named_[name] = static_cast<int>(values_.size());
  values_.push_back(std::move(value));
}

int Materials::find(const std::string& name, const Place& place) const {
  const auto found = named_.find(name);
  if (found != named_.end()) return found->second;
  warnings_.once(place, "there is no material of the name " + in_quotes(name) + "; a grey one stands in");
  return 0;
}

float Materials::roughness(const ParameterList& parameters, float otherwise, bool is_version_3) const {
  const float both = textures_.number(parameters, "roughness", otherwise);
  const float u = textures_.number(parameters, "uroughness", both),
              v = textures_.number(parameters, "vroughness", both);
  const bool is_remapped = parameters.boolean("remaproughness", true);

  // Ours is the same in all directions: the geometric mean keeps the size of the highlight.
  const float alpha_u = is_remapped ? alpha_of_roughness(u, is_version_3) : u;
  const float alpha_v = is_remapped ? alpha_of_roughness(v, is_version_3) : v;
  if (u != v) {
    const Parameter* parameter = parameters.find("uroughness");
    warnings_.once((parameter != nullptr ? parameter : parameters.find("vroughness"))->place,
                   "roughness that differs between u and v is not supported; the mean stands in");
  }
  const float alpha = alpha_u == alpha_v ? alpha_u : std::sqrt(std::max(alpha_u * alpha_v, 0.0f));
  return std::min(std::max(alpha, 0.0f), 1.0f);
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
    return textures_.color(parameters, name, {splat(otherwise), -1});
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
    value.material.roughness = roughness(parameters, roughness_default, is_version_3);
    return value;
  };

  if (kind == "matte" || kind == "diffuse")
    return of_kind(Kind::matte, color(kind == "matte" ? "Kd" : "reflectance", 0.5f));
  if (kind == "plastic" || kind == "substrate") {
    // The strength of the gloss follows from the index of refraction here, not from a color.
    const bool is_plastic = kind == "plastic";
    parameters.ignore({"Ks"});
    return plastic("Kd", is_plastic ? 0.25f : 0.5f, 0.1f, true);
  }
  if (kind == "coateddiffuse") {
    MaterialValue value = plastic("reflectance", 0.5f, 0, false);
    value.material.ior = ior(1.5f);
    parameters.ignore({"maxdepth", "nsamples"});
    return value;
  }
  if (kind == "uber") {
    const Vec3 opacity = textures_.plain_color(parameters, "opacity", {1, 1, 1});
    if (max_component(opacity) <= 0) {
      parameters.ignore({"Kd", "Ks", "Kr", "Kt", "roughness", "uroughness", "vroughness", "remaproughness",
                         "eta", "index"});
      return clear();
    }
    if (min_component(opacity) < 1)
      warn("surfaces that are partly transparent (uber with \"opacity\") are not supported; they are opaque");
    if (max_component(textures_.plain_color(parameters, "Kt", {0, 0, 0})) > 0)
      warn("uber materials that transmit light (\"Kt\") are not supported; they are opaque");
    const bool is_glossy = max_component(textures_.plain_color(parameters, "Ks", {0.25f, 0.25f, 0.25f})) > 0;
    const bool is_shiny = max_component(textures_.plain_color(parameters, "Kr", {0, 0, 0})) > 0;
    MaterialValue value = plastic("Kd", 0.25f, 0.1f, true);
    value.material.ior = ior(1.5f);
    if (is_shiny) value.material.roughness = 0;
    if (!is_glossy && !is_shiny) value.material.kind = Kind::matte;
    return value;
  }
  if (kind == "metal" || kind == "conductor") {
    MaterialValue value = of_kind(Kind::metal, {metal_color(parameters, ""), -1});
    value.material.roughness = roughness(parameters, kind == "metal" ? 0.01f : 0, kind == "metal");
    return value;
  }
  if (kind == "coatedconductor") {
    MaterialValue value = of_kind(Kind::metal, {metal_color(parameters, "conductor."), -1});
    value.material.roughness =
        std::sqrt(std::max(0.0f, textures_.number(parameters, "conductor.roughness", 0)));
    value.material.roughness = std::min(value.material.roughness, 1.0f);
    stands_in("the metal without its coat");
    return value;
  }
  if (kind == "mirror") return of_kind(Kind::mirror, color("Kr", 0.9f));
  if (kind == "glass" || kind == "dielectric") {
    MaterialValue value = of_kind(Kind::glass, {textures_.plain_color(parameters, "Kt", {1, 1, 1}), -1});
    value.material.ior = ior(1.5f);
    parameters.ignore({"Kr"});
    if (roughness(parameters, 0, kind == "glass") > 0) warn("rough glass is not supported; it is smooth");
    return value;
  }
  if (kind == "thindielectric") {
    parameters.ignore({"eta"});
    warn("the reflections of \"thindielectric\" are not supported; it is clear");
    return clear();
  }
  if (kind == "none" || kind == "interface" || kind.empty()) return clear();
  if (kind == "mix") {
    // The first of the two: named so in version 3, listed in version 4.
    const Parameter* first = parameters.find("namedmaterial1");
    if (first == nullptr) first = parameters.find("materials");
    const std::string name = first != nullptr && !first->strings.empty() ? first->strings[0] : "";
    stands_in("the first material of the mix");
    return values_[find(name, directive.place)];
  }
  if (kind == "disney") {
    const float rough = textures_.number(parameters, "roughness", 0.5f);
    const bool is_metal = textures_.number(parameters, "metallic", 0) > 0.5f;
    MaterialValue value = of_kind(is_metal ? Kind::metal : Kind::plastic, color("color", 0.5f));
    value.material.roughness = std::min(std::max(rough * rough, 0.0f), 1.0f);
    stands_in(is_metal ? "a metal of its color" : "a plastic of its color");
    return value;
  }

  // Whatever scatters light below or through its surface, and what is not known at all: matte, in the color
  // that it gives.
  const char* color_name = parameters.find("Kd") != nullptr      ? "Kd"
                           : parameters.find("color") != nullptr ? "color"
                                                                 : "reflectance";
  MaterialValue value = of_kind(Kind::matte, color(color_name, 0.5f));
  stands_in("a matte one");
  return value;
}

}  // namespace boxwood::io::pbrt
