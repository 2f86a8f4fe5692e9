// pbrt_texture.h: what does a named texture stand for?
//
// A surface of ours has a color times at most one picture. Every pbrt texture is reduced to that when it is
// defined: exactly for constants, pictures and products of them, and to a plain mean, with a warning, for
// patterns.
#pragma once

#include <map>

#include "boxwood/io/pbrt_parser.h"

namespace boxwood::io::pbrt {

/// A color, multiplied by a picture where `picture` is not negative.
struct TextureValue {
  Vec3 color{1, 1, 1};
  int picture = -1;  ///< Position in Textures::pictures().
};

/// A picture that some texture needs; read only when a material uses it.
struct Picture {
  std::filesystem::path path;
  /// The file says "linear" in so many words; else the picture's own format decides.
  bool is_linear = false;
  Place place;
};

class Textures {
 public:
  Textures(const Parser& parser, Warnings& warnings) : parser_(parser), warnings_(warnings) {}

  /// Takes a Texture directive. Throws FileError for values that do not fit.
  void define(const Directive& directive);

  /// A parameter that may be a color or a texture of colors; `otherwise` when it is absent or unknown.
  TextureValue color(const ParameterList& parameters, std::string_view name, TextureValue otherwise) const;
  Vec3 plain_color(const ParameterList& parameters, std::string_view name, Vec3 otherwise) const;
  /// A parameter that may be a number or a texture of numbers;
  /// a picture counts as `otherwise`, with a warning.
  float number(const ParameterList& parameters, std::string_view name, float otherwise) const;

  const std::vector<Picture>& pictures() const { return pictures_; }

 private:
  TextureValue image_map(const Directive& directive);
  TextureValue mean_of_two(const Directive& directive, float second_share) const;
  TextureValue evaluate(const Directive& directive);
  const TextureValue* find(const Parameter& parameter, bool of_numbers) const;

  const Parser& parser_;
  Warnings& warnings_;
  std::map<std::string, TextureValue, std::less<>> colors_, numbers_;
  std::vector<Picture> pictures_;
};

}  // namespace boxwood::io::pbrt
