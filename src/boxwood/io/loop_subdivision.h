// loop_subdivision.h: which smooth surface does a mesh of triangles stand for?
//
// Each step cuts every triangle into four and moves the vertices to weighted means of their neighbours; in
// the end each vertex is pushed to where endless steps would bring it. Loop, "Smooth Subdivision Surfaces
// Based on Triangles", 1987; edges that belong to one triangle stay as creases.
#pragma once

#include "boxwood/scene/description.h"

namespace boxwood::io {

/// `levels` steps, then the limit, with normals. Stops early before the mesh has more than 2^22 triangles.
/// Edges that three triangles share are treated as creases.
TriangleMesh subdivide(const TriangleMesh& cage, int levels);

}  // namespace boxwood::io
