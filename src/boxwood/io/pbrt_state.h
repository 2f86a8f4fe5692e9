// pbrt_state.h: what applies to the next shape?
//
// The attributes that directives set one by one (transform, material, area light, orientation) and the stack
// that AttributeBegin, TransformBegin and ObjectBegin push. Each End must close the Begin of its own kind.
#pragma once

#include "boxwood/io/pbrt_light.h"
#include "boxwood/io/pbrt_material.h"
#include "boxwood/io/pbrt_shape.h"

namespace boxwood::io::pbrt {

struct Attributes {
  ShapeFrame frame;
  int material = 0;  ///< Position in Materials::values().
  std::optional<Glow> glow;
  Vec3 inner_absorption{0, 0, 0}, outer_absorption{0, 0, 0};  ///< Of the media on both sides of a surface.
  bool is_end_of_motion = false;  ///< Transforms count for the shutter's closing only.
  std::map<std::string, ParameterList, std::less<>> defaults;  ///< By the Attribute directive's target.
};

class State {
 public:
  Attributes now;

  void begin(const Directive& directive);
  /// Throws FileError when the last Begin that is open is of another kind, or there is none.
  void end(const Directive& directive);
  /// Throws FileError when a Begin is still open.
  void expect_all_closed() const;

  /// Changes the transform by one of Identity, Translate, Scale, Rotate, LookAt, Transform, ConcatTransform,
  /// CoordinateSystem and CoordSysTransform. False for other directives. Throws FileError for transforms that
  /// are not affine.
  bool transform(const Directive& directive, Warnings& warnings);
  void name_coordinate_system(const std::string& name, const Affine3& m) { coordinate_systems_[name] = m; }

 private:
  struct Open {
    std::string kind;  // "Attribute", "Transform", "Object"
    Place place;
    Attributes before;
  };
  std::vector<Open> open_;
  std::map<std::string, Affine3, std::less<>> coordinate_systems_;
};

/// Takes the "Begin" or "End" off a directive's name.
std::string bracket_kind(const std::string& directive_name);

}  // namespace boxwood::io::pbrt
