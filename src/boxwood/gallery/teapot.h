// teapot.h: what does the Utah teapot look like, as triangles?
//
// The 32 bicubic Bezier patches of Martin Newell, University of Utah, 1975, in the proportions of Blinn's
// tables ("What, Teapots Again?", IEEE CG&A, 1987), bottom included. Most of the 306 control points follow
// from symmetry; teapot.cpp writes down 34 rows of numbers that give them all.
#pragma once

#include <array>
#include <vector>

#include "boxwood/scene/description.h"

namespace boxwood::gallery {

/// Control points [row][column]: rows run with u, columns with v, and d/du x d/dv points out of the teapot.
using BezierPatch = std::array<std::array<Vec3, 4>, 4>;

/// The 32 patches: body from rim to bottom (16), lid (8), handle (4), spout (4). Y is up, the axis is x = z =
/// 0, the bottom touches y = 0, the knob ends at y = 3.15 and the spout points along +x.
std::vector<BezierPatch> teapot_patches();

/// The teapot with `segments` x `segments` cells a patch, two triangles each, and the exact normals of the
/// patches. Patches of one part share the vertices on their borders, so no seam can leak. Open, as in
/// Newell's model, are the rim under the lid, the edge of the lid, and both ends of handle and spout.
/// Precondition: segments >= 2 (with one, the two halves of a tube would be the same flat piece).
TriangleMesh teapot_mesh(int segments);

}  // namespace boxwood::gallery
