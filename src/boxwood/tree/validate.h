// validate.h: is this a tree?
#pragma once

#include <span>
#include <string>

#include "boxwood/tree/bvh.h"
#include "boxwood/tree/wide.h"

namespace boxwood {

/// Checks every invariant of bvh.h against the boxes of the primitives. Returns an empty string when all
/// hold, else the first broken one in a sentence that names the node. Safe on any bytes: indices out of
/// range, cycles, NaN. Cost: linear.
std::string validate(const Bvh& bvh, std::span<const Box3> boxes);

/// The same for the invariants of wide.h.
template <int W>
std::string validate(const WideBvh<W>& wide, std::span<const Box3> boxes);

extern template std::string validate(const WideBvh<4>&, std::span<const Box3>);
extern template std::string validate(const WideBvh<8>&, std::span<const Box3>);

}  // namespace boxwood
