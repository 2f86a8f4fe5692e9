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
  if (kind == "constant") return {plain_color(parameters, "value", {1, 1, 1}), {}};
  if (kind == "scale") {
    // Version 3 multiplies tex1 and tex2, version 4 multiplies tex and scale.
    const bool is_new = parameters.find("tex") != nullptr || parameters.find("scale") != nullptr;
    const TextureValue a = color(parameters, is_new ? "tex" : "tex1", {}),
                       b = color(parameters, is_new ? "scale" : "tex2", {});
    if (a.is_plain() || b.is_plain()) return {a.color * b.color, a.is_plain() ? b.texture : a.texture};
    Texture product;
    product.name = directive.strings[0];
    product.kind = Texture::Kind::product;
    product.first = {a.color, a.texture};
    product.second = {b.color, b.texture};
    return {{1, 1, 1}, desc_.add(std::move(product))};
  }
  if (kind == "mix") return mix(directive);
  if (kind == "checkerboard" && parameters.integer("dimension", 2) == 2) return checkerboard(directive);
  if (kind == "checkerboard" || kind == "dots") {
    const bool is_dots = kind == "dots";
    const TextureValue mean =
        mean_of_two(directive, is_dots ? "outside" : "tex1", is_dots ? "inside" : "tex2");
    parameters.ignore({"dimension", "mapping", "uscale", "vscale", "udelta", "vdelta", "v1", "v2", "aamode"});
    warnings_.once(directive.place, "the pattern of a " + in_quotes(kind) +
                                        " texture is not supported; its mean color stands in");
    return mean;
  }
  for (const Parameter& parameter : parameters.all()) parameter.is_used = true;
  warnings_.once(directive.place,
                 "textures of the kind " + in_quotes(kind) + " are not supported; plain grey stands in");
  return {{0.5f, 0.5f, 0.5f}, {}};
}

/// Where the texture lies on the surface.
void Textures::place(const Directive& directive, Texture& texture) const {
  const ParameterList& parameters = directive.parameters;
  if (parameters.string("mapping", "uv") != "uv") {
    parameters.ignore({"v1", "v2"});
    warnings_.once(directive.place,
                   "textures with a mapping other than \"uv\" are not supported; the uvs are taken");
  }
  texture.u_axis = {parameters.number("uscale", 1), 0};
  texture.v_axis = {0, parameters.number("vscale", 1)};
  texture.offset = {parameters.number("udelta", 0), parameters.number("vdelta", 0)};
}

TextureValue Textures::image_map(const Directive& directive) {
  const ParameterList& parameters = directive.parameters;
  const std::string file = parameters.string("filename", "");
  if (file.empty())
    fail(directive.place,
         "Texture " + in_quotes(directive.strings[0]) + " is an imagemap without a \"filename\"");
  // How it is sampled is the renderer's to decide.
  parameters.ignore({"trilinear", "filter", "maxanisotropy"});

  Picture picture{parser_.resolve(file), false, {}, directive.place};
  const std::string encoding = parameters.string("encoding", "sRGB");
  picture.is_linear = !parameters.boolean("gamma", true) || encoding == "linear";
  if (encoding != "sRGB" && encoding != "linear")
    warnings_.once(directive.place,
                   "the encoding " + in_quotes(encoding) + " is not supported; sRGB stands in");
  Texture texture;
  texture.name = picture.path.string();
  place(directive, texture);
  const std::string wrap = parameters.string("wrap", "repeat");
  texture.wrap_u = texture.wrap_v = wrap == "black"   ? Texture::Wrap::black
                                    : wrap == "clamp" ? Texture::Wrap::clamp
                                                      : Texture::Wrap::repeat;
  if (wrap != "black" && wrap != "clamp" && wrap != "repeat")
    warnings_.once(directive.place,
                   "imagemap textures that wrap by " + in_quotes(wrap) + " are not supported; they repeat");
  texture.is_inverted = parameters.boolean("invert", false);
  picture.texture = desc_.add(std::move(texture));
  const float scale = number(parameters, "scale", 1);
  pictures_.push_back(std::move(picture));
  return {splat(scale), pictures_.back().texture};
}

TextureId Textures::normal_map(const std::string& file, const Place& place) {
  Texture texture;
  texture.name = file;
  const TextureId id = desc_.add(std::move(texture));
  pictures_.push_back({parser_.resolve(file), true, id, place});
  return id;
}

TextureValue Textures::mix(const Directive& directive) {
  const TextureValue a = color(directive.parameters, "tex1", {{0, 0, 0}, {}}),
                     b = color(directive.parameters, "tex2", {});
  const NumberValue amount = number_or_texture(directive.parameters, "amount", 0.5f);
  const bool has_plain_amount = !amount.texture.texture.is_valid();
  if (a.is_plain() && b.is_plain() && has_plain_amount)
    return {a.color * (1 - amount.number) + b.color * amount.number, {}};
  Texture texture;
  texture.name = directive.strings[0];
  texture.kind = Texture::Kind::mix;
  texture.first = {a.color, a.texture};
  texture.second = {b.color, b.texture};
  texture.amount = {splat(amount.number), amount.texture.texture};
  return {{1, 1, 1}, desc_.add(std::move(texture))};
}

TextureValue Textures::checkerboard(const Directive& directive) {
  const TextureValue a = color(directive.parameters, "tex1", {}),
                     b = color(directive.parameters, "tex2", {{0, 0, 0}, {}});
  directive.parameters.ignore({"aamode"});
  Texture texture;
  texture.name = directive.strings[0];
  texture.kind = Texture::Kind::checkerboard;
  place(directive, texture);
  texture.first = {a.color, a.texture};
  texture.second = {b.color, b.texture};
  return {{1, 1, 1}, desc_.add(std::move(texture))};
}

TextureValue Textures::mean_of_two(const Directive& directive, const char* first, const char* second) const {
  const TextureValue a = color(directive.parameters, first, {{0, 0, 0}, {}}),
                     b = color(directive.parameters, second, {});
  if (a.is_plain() && b.is_plain()) return {(a.color + b.color) * 0.5f, {}};
  return a.is_plain() ? b : a;
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
    return {max(color_of(*parameter, parser_, warnings_).value_or(otherwise.color), Vec3{0, 0, 0}), {}};

  // Textures of numbers are textures of greys.
  const auto grey = parameter->strings.size() == 1 ? numbers_.find(parameter->strings[0]) : numbers_.end();
  if (grey != numbers_.end() && colors_.find(parameter->strings[0]) == colors_.end()) return grey->second;
  const TextureValue* value = find(*parameter, false);
  return value != nullptr ? *value : otherwise;
}

Vec3 Textures::plain_color(const ParameterList& parameters, std::string_view name, Vec3 otherwise) const {
  const TextureValue value = color(parameters, name, {otherwise, {}});
  if (value.is_plain()) return value.color;
  warnings_.once(parameters.find(name)->place,
                 "a picture for " + in_quotes(name) + " is not supported; the default stands in");
  return otherwise;
}

NumberValue Textures::number_or_texture(const ParameterList& parameters, std::string_view name,
                                        float otherwise) const {
  const Parameter* parameter = parameters.find(name);
  if (parameter == nullptr) return {otherwise, {}};
  if (parameter->type == "texture") {
    const TextureValue* value = find(*parameter, true);
    if (value == nullptr) return {otherwise, {}};
    return {value->color.x, {value->texture, NumberTexture::Channel::mean}};
  }
  // Version 3 gives some shares, such as that of a mix, as colors.
  if (parameter->numbers.size() == 3 && parameter->type != "float")
    return {static_cast<float>((parameter->numbers[0] + parameter->numbers[1] + parameter->numbers[2]) / 3),
            {}};
  return {parameters.number(name, otherwise), {}};
}

float Textures::number(const ParameterList& parameters, std::string_view name, float otherwise) const {
  const NumberValue value = number_or_texture(parameters, name, otherwise);
  if (!value.texture.texture.is_valid()) return value.number;
  warnings_.once(parameters.find(name)->place,
                 "a picture for " + in_quotes(name) + " is not supported; the default stands in");
  return otherwise;
}

}  // namespace boxwood::io::pbrt
