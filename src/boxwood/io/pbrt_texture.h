// pbrt_texture.h: what does a named texture stand for?
//
// Pictures, products, mixes and checkerboards become textures of the scene, constants are folded away, and
// other patterns are reduced to a plain color, with a warning.
#pragma once

#include <map>

#include "boxwood/io/pbrt_parser.h"

namespace boxwood::io::pbrt {

/// A color times a texture, where there is one.
struct TextureValue {
  Vec3 color{1, 1, 1};
  TextureId texture;

  bool is_plain() const { return !texture.is_valid(); }
};

/// A number times a texture of numbers.
struct NumberValue {
  float number = 1;
  NumberTexture texture;
};

/// A picture that some texture needs; read only when a material uses it.
struct Picture {
  std::filesystem::path path;
  /// The file says "linear" in so many words; else the picture's own format decides.
  bool is_linear = false;
  TextureId texture;  ///< Its place in the scene.
  Place place;
};

class Textures {
 public:
  /// Textures are added to `desc` as they are defined, their pictures still empty.
  Textures(const Parser& parser, Warnings& warnings, SceneDesc& desc)
      : parser_(parser), warnings_(warnings), desc_(desc) {}

  /// Takes a Texture directive. Throws FileError for values that do not fit.
  void define(const Directive& directive);

  /// A parameter that may be a color or a texture of colors; `otherwise` when it is absent or unknown.
  TextureValue color(const ParameterList& parameters, std::string_view name, TextureValue otherwise) const;
  Vec3 plain_color(const ParameterList& parameters, std::string_view name, Vec3 otherwise) const;
  /// A parameter that may be a number or a texture of numbers.
  NumberValue number_or_texture(const ParameterList& parameters, std::string_view name,
                                float otherwise) const;
  /// As number_or_texture(), where only a plain number will do:
  /// a texture counts as `otherwise`, with a warning.
  float number(const ParameterList& parameters, std::string_view name, float otherwise) const;

  /// The texture of a picture of normals.
  TextureId normal_map(const std::string& file, const Place& place);

  const std::vector<Picture>& pictures() const { return pictures_; }

 private:
  TextureValue image_map(const Directive& directive);
  TextureValue mix(const Directive& directive);
  TextureValue checkerboard(const Directive& directive);
  TextureValue mean_of_two(const Directive& directive, const char* first, const char* second) const;
  void place(const Directive& directive, Texture& texture) const;
  TextureValue evaluate(const Directive& directive);
  const TextureValue* find(const Parameter& parameter, bool of_numbers) const;

  const Parser& parser_;
  Warnings& warnings_;
  SceneDesc& desc_;
  std::map<std::string, TextureValue, std::less<>> colors_, numbers_;
  std::vector<Picture> pictures_;
};

}  // namespace boxwood::io::pbrt
