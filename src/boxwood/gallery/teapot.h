// teapot.h: what does the Utah teapot look like, as triangles?
//
// The 32 bicubic Bezier patches of Martin Newell, University of Utah, 1975, in the proportions of Blinn's
// tables
// ("What, Teapots Again?", IEEE CG&A, 1987), bottom included. Of the 306 control points all but 14 rows
// follow from symmetry, and only those rows are written down (teapot.cpp).
#pragma once

#include <array>
#include <vector>

#include "boxwood/scene/description.h"

namespace boxwood::gallery {

/// Control points [row][column]: rows run with u, columns with v, and d/du x d/dv points out of the teapot.
using BezierPatch = std::array<std::array<Vec3, 4>, 4>;

/// The 32 patches: 4 of the rim, 16 of body and bottom... in the order body (16), lid (8), handle (4), spout
/// (4). Y is up, the axis is x = z = 0, the bottom stands on y = 0, the knob ends at y = 3.15 and the spout
/// points along +x.
std::vector<BezierPatch> teapot_patches();

/// The teapot with `segments` x `segments` quads a patch, each of two triangles, and the exact normals of the
/// patches. Vertices on the borders of patches are shared, so no seam can leak; open, as in Newell's model,
/// are the rim under the lid, the rim of the lid, and both ends of handle and spout. Precondition: segments
/// >= 1.
TriangleMesh teapot_mesh(int segments);

}  // namespace boxwood::gallery
