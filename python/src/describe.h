// describe.h: how do arrays become a description of a scene, and a description a line of text?
#pragma once

#include <string>

#include <nanobind/nanobind.h>

#include "boxwood/build/options.h"
#include "boxwood/scene/description.h"

namespace boxwood::python {

namespace nb = nanobind;

/// A mesh of (n, 3) vertices and (m, 3) indices; normals (n, 3) or None. Throws ValueError, TypeError that
/// name the argument and the place.
TriangleMesh read_mesh(nb::handle vertices, nb::handle triangles, nb::handle normals, nb::handle uvs);

/// What is expected of the position of one among so many, for messages: "0 to 6".
std::string positions_of(std::size_t count, const char* what);

/// "2 meshes (4096 triangles), 1 list of spheres (10)".
std::string summary(const SceneDesc& desc);

/// Those of the geometries, in order.
nb::list names_of(const SceneDesc& desc);
inline constexpr char kGeometryNames[] =
    "What each geometry is called, by its geometry_id: from the file, or as add_mesh and the others were "
    "told; "
    "may be empty.";

/// (4, 4), in double, as NumPy users write transforms: world = m @ (x, y, z, 1).
nb::object array_of(const Affine3& m);

void bind_description(nb::module_& module);

}  // namespace boxwood::python
