#include "boxwood/io/pbrt_texture.h"

#include "boxwood/io/pbrt_spectrum.h"

namespace boxwood::io::pbrt {

void Textures::define(const Directive& directive) {
  const std::string& name = directive.strings[0];
  const std::string& type = directive.strings[1];
  if (type != "float" && type != "spectrum" && type != "color")
    fail(directive.place, "Texture " + in_quotes(name) + " is of type " + in_quotes(type) +
                              ", expected \"float\" or \"spectrum\"");
  const TextureValue value = evaluate(directive);
  directive.parameters.warn_unused(directive.subject(), warnings_);
  (type == "float" ? numbers_ : colors_)[name] = value;
}

TextureValue Textures::evaluate(const Directive& directive) {
  const ParameterList& parameters = directive.parameters;
  const std::string& kind = directive.strings[2];
  if (kind == "imagemap") return image_map(directive);
  if (kind == "constant") return {plain_color(parameters, "value", {1, 1, 1}), -1};
  if (kind == "scale") {
    // Version 3 multiplies tex1 and tex2, version 4 multiplies tex and scale.
    const bool is_new = parameters.find("tex") != nullptr || parameters.find("scale") != nullptr;
    const TextureValue a = color(parameters, is_new ? "tex" : "tex1", {}),
                       b = color(parameters, is_new ? "scale" : "tex2", {});
    if (a.picture >= 0 && b.picture >= 0)
      warnings_.once(directive.place, "a product of two pictures is not supported; the first one stands in");
    return {a.color * b.color, a.picture >= 0 ? a.picture : b.picture};
  }
  if (kind == "mix") return mean_of_two(directive, number(parameters, "amount", 0.5f));
  if (kind == "checkerboard" || kind == "dots") {
    const TextureValue mean = mean_of_two(directive, 0.5f);
    parameters.ignore({"dimension", "mapping", "uscale", "vscale", "udelta", "vdelta", "v1", "v2", "aamode"});
    warnings_.once(directive.place, "the pattern of a " + in_quotes(kind) +
                                        " texture is not supported; its mean color stands in");
    return mean;
  }
  for (const Parameter& parameter : parameters.all()) parameter.is_used = true;
  warnings_.once(directive.place,
                 "textures of the kind " + in_quotes(kind) + " are not supported; plain grey stands in");
  return {{0.5f, 0.5f, 0.5f}, -1};
}

TextureValue Textures::image_map(const Directive& directive) {
  const ParameterList& parameters = directive.parameters;
  const std::string file = parameters.string("filename", "");
  if (file.empty())
    fail(directive.place,
         "Texture " + in_quotes(directive.strings[0]) + " is an imagemap without a \"filename\"");
  // How it is sampled is the renderer's to decide.
  parameters.ignore({"trilinear", "filter", "maxanisotropy"});

  Picture picture{parser_.resolve(file), false, directive.place};
  picture.is_linear = !parameters.boolean("gamma", true) || parameters.string("encoding", "sRGB") == "linear";
  const TextureValue value{splat(number(parameters, "scale", 1)), static_cast<int>(pictures_.size())};

  // Where the picture lies on the surface: as the uvs say is all we know.
  if (parameters.string("mapping", "uv") != "uv" || parameters.number("uscale", 1) != 1 ||
      parameters.number("vscale", 1) != 1 || parameters.number("udelta", 0) != 0 ||
      parameters.number("vdelta", 0) != 0)
    warnings_.once(directive.place,
                   "imagemap textures with a mapping, scale or shift of their own are not supported; the uvs "
                   "are taken as they are");
  if (parameters.string("wrap", "repeat") != "repeat")
    warnings_.once(directive.place, "imagemap textures that do not repeat are not supported; they repeat");
  if (parameters.boolean("invert", false))
    warnings_.once(directive.place, "inverted imagemap textures are not supported");

  // The same picture under two names is one.
  for (std::size_t i = 0; i < pictures_.size(); ++i)
    if (pictures_[i].path == picture.path && pictures_[i].is_linear == picture.is_linear)
      return {value.color, static_cast<int>(i)};
  pictures_.push_back(std::move(picture));
  return value;
}

TextureValue Textures::mean_of_two(const Directive& directive, float second_share) const {
  const TextureValue a = color(directive.parameters, "tex1", {{0, 0, 0}, -1}),
                     b = color(directive.parameters, "tex2", {});
  if (a.picture < 0 && b.picture < 0) return {a.color * (1 - second_share) + b.color * second_share, -1};
  warnings_.once(directive.place, "a mix of pictures is not supported; the larger part stands in");
  return second_share > 0.5f ? b : a;
}

const TextureValue* Textures::find(const Parameter& parameter, bool of_numbers) const {
  const auto& table = of_numbers ? numbers_ : colors_;
  if (parameter.strings.size() != 1)
    fail(parameter.place, in_quotes(parameter.name) + " is not one texture's name");
  const auto found = table.find(parameter.strings[0]);
  if (found != table.end()) return &found->second;
  warnings_.once(parameter.place, "there is no texture of the name " + in_quotes(parameter.strings[0]) +
                                      " for " + in_quotes(parameter.name) + "; the default stands in");
  return nullptr;
}

TextureValue Textures::color(const ParameterList& parameters, std::string_view name,
                             TextureValue otherwise) const {
  const Parameter* parameter = parameters.find(name);
  if (parameter == nullptr) return otherwise;
  if (parameter->type != "texture")
    return {max(color_of(*parameter, parser_, warnings_).value_or(otherwise.color), Vec3{0, 0, 0}), -1};

  // Textures of numbers are textures of greys.
  const auto grey = parameter->strings.size() == 1 ? numbers_.find(parameter->strings[0]) : numbers_.end();
  if (grey != numbers_.end() && colors_.find(parameter->strings[0]) == colors_.end()) return grey->second;
  const TextureValue* value = find(*parameter, false);
  return value != nullptr ? *value : otherwise;
}

Vec3 Textures::plain_color(const ParameterList& parameters, std::string_view name, Vec3 otherwise) const {
  const TextureValue value = color(parameters, name, {otherwise, -1});
  if (value.picture < 0) return value.color;
  warnings_.once(parameters.find(name)->place,
                 "a picture for " + in_quotes(name) + " is not supported; the default stands in");
  return otherwise;
}

float Textures::number(const ParameterList& parameters, std::string_view name, float otherwise) const {
  const Parameter* parameter = parameters.find(name);
  if (parameter == nullptr) return otherwise;
  if (parameter->type != "texture") return parameters.number(name, otherwise);
  const TextureValue* value = find(*parameter, true);
  if (value == nullptr) return otherwise;
  if (value->picture < 0) return value->color.x;
  warnings_.once(parameter->place,
                 "a picture for " + in_quotes(name) + " is not supported; the default stands in");
  return otherwise;
}

}  // namespace boxwood::io::pbrt
