// pbrt_material.h: which of our materials is nearest to one of pbrt's?
//
// The two versions of the format know some twenty kinds of surface, the renderer five. Each kind is mapped to
// the one that looks most like it; what that loses is said in a warning.
#pragma once

#include "boxwood/io/pbrt_texture.h"

namespace boxwood::io::pbrt {

/// One of our materials whose picture is not read yet.
struct MaterialValue {
  Material material;
  int picture = -1;  ///< Position in Textures::pictures(), or none.
};

/// Every material that the scene has named or used so far.
class Materials {
 public:
  Materials(const Textures& textures, const Parser& parser, Warnings& warnings);

  /// Takes a Material directive; returns the position of its material in values().
  int add(const Directive& directive);
  /// Takes a MakeNamedMaterial directive.
  void define(const Directive& directive);
  /// The position of the material that a NamedMaterial directive means; the default one, with a warning, when
  /// the name is unknown.
  int find(const std::string& name, const Place& place) const;

  /// The first is the default: what pbrt gives to shapes that come before any Material.
  const std::vector<MaterialValue>& values() const { return values_; }

 private:
  MaterialValue evaluate(const std::string& kind, const Directive& directive) const;
  float roughness(const ParameterList& parameters, float otherwise, bool is_version_3) const;
  Vec3 metal_color(const ParameterList& parameters, const std::string& prefix) const;

  const Textures& textures_;
  const Parser& parser_;
  Warnings& warnings_;
  std::vector<MaterialValue> values_;
  std::map<std::string, int, std::less<>> named_;
};

}  // namespace boxwood::io::pbrt
