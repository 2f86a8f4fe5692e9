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

/// "2 meshes (4096 triangles), 1 list of spheres (10)".
std::string summary(const SceneDesc& desc);

/// What pickle carries: plain tuples, numbers and bytes.
nb::tuple state_of(const SceneDesc& desc);
SceneDesc desc_of(const nb::tuple& state);
nb::tuple state_of(const BuildOptions& options);
BuildOptions options_of(const nb::tuple& state);

/// (4, 4), in double, as NumPy users write transforms: world = m @ (x, y, z, 1).
nb::object array_of(const Affine3& m);

void bind_description(nb::module_& module);

}  // namespace boxwood::python
