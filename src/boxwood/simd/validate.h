// validate.h: is this what the kernels may walk?
#pragma once

#include <string>

#include "boxwood/simd/triangle_tree.h"

namespace boxwood::simd {

/// Checks the invariants of a packed tree: those of wide.h against the boxes of its triangles, and that lanes
/// that only fill a block repeat its first triangle, corners too. Returns an empty string when all hold, else
/// the first broken one in a sentence. Safe on any bytes. Cost: n log n, and twice the memory.
std::string validate(const TriangleTree& tree);

}  // namespace boxwood::simd
