// pbrt_material.h: which of our materials is nearest to one of pbrt's?
//
// The two versions of the format know some twenty kinds of surface. Each is mapped to the one of ours that
// looks most like it; what that loses is said in a warning.
#pragma once

#include "boxwood/io/pbrt_texture.h"

namespace boxwood::io::pbrt {

/// One of our materials, not in the scene yet.
struct MaterialValue {
  Material material;
  int first = -1, second = -1;  ///< Of a mix: positions in Materials::values().
};

/// Every material that the scene has named or used so far.
class Materials {
 public:
  Materials(Textures& textures, const Parser& parser, Warnings& warnings);

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
  void set_roughness(Material& material, const ParameterList& parameters, float otherwise,
                     bool is_version_3) const;
  MaterialValue mix(const Directive& directive) const;
  MaterialValue uber(const Directive& directive, float ior) const;
  MaterialValue disney(const Directive& directive, float ior) const;
  /// Bumps and a normal map.
  void set_relief(Material& material, const Directive& directive);
  void set_metal(Material& material, const ParameterList& parameters, const std::string& prefix) const;
  Vec3 metal_color(const ParameterList& parameters, const std::string& prefix) const;

  Textures& textures_;
  const Parser& parser_;
  Warnings& warnings_;
  std::vector<MaterialValue> values_;
  std::map<std::string, int, std::less<>> named_;
};

/// Which share of a shape is there at all.
struct Coverage {
  bool is_given = false;
  NumberValue opacity;
};

/// The "alpha" of a Shape directive.
Coverage read_coverage(const Directive& shape, const Textures& textures);

}  // namespace boxwood::io::pbrt
