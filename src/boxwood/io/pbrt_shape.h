// pbrt_shape.h: which geometry does a Shape directive make?
//
// Meshes are baked: their vertices move to the space that the transform leads to, so that a scene without
// instances is one flat world. Spheres and disks are baked where the transform keeps them round, and placed
// by an instance elsewhere.
//
// pbrt lets a shape's front side follow the transform, mirrored or not, turns it over for ReverseOrientation,
// and lets given normals decide where there are any. The order of a triangle's corners says the same here.
#pragma once

#include "boxwood/io/pbrt_parser.h"

namespace boxwood::io::pbrt {

/// A shape whose PLY file, if it has one, is not read yet.
struct ShapeValue {
  Geometry geometry;
  Affine3 placement;          ///< Identity for what is baked.
  std::filesystem::path ply;  ///< Not empty: read this file and bake it, then it is the geometry.
};

/// Where a shape stands and which way it faces.
struct ShapeFrame {
  Affine3 world_from_object;
  bool is_reversed = false;  ///< ReverseOrientation.
  /// Its material bends normals along texture coordinates, which takes a mesh.
  bool has_relief = false;
};

/// The shape of a Shape directive; none, with a warning, for kinds that are not supported. Throws FileError
/// for parameters that make no shape. Parameters that nobody asks for are the caller's to name.
std::optional<ShapeValue> make_shape(const Directive& directive, const ShapeFrame& frame,
                                     const Parser& parser, Warnings& warnings);

/// Moves a mesh to where it stands.
void bake(TriangleMesh& mesh, const ShapeFrame& frame);

}  // namespace boxwood::io::pbrt
