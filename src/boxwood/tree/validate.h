// validate.h: is this a tree?
#pragma once

#include <span>
#include <string>

#include "boxwood/tree/bvh.h"

namespace boxwood {

/// Checks every invariant of bvh.h against the boxes of the primitives. Returns an empty string when all
/// hold, else the first broken one in a sentence that names the node. Safe on any bytes: indices out of
/// range, cycles, NaN. Cost: linear.
std::string validate(const Bvh& bvh, std::span<const Box3> boxes);

}  // namespace boxwood
