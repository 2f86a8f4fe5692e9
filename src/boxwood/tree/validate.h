// validate.h: is this a tree?
#pragma once

#include <span>
#include <string>

#include "boxwood/tree/bvh.h"
#include "boxwood/tree/wide.h"

namespace boxwood {

/// Whether a primitive may stand in several leaves, each holding a part of it.
enum class Repeats { refused, allowed };

/// Checks every invariant of bvh.h against the boxes of the primitives. Returns an empty string when all
/// hold, else the first broken one in a sentence that names the node. Safe on any bytes: indices out of
/// range, cycles, NaN. Cost: linear.
/// With Repeats::allowed invariants 4 and 5 are: each primitive stands in at least one leaf, once in each,
/// and the boxes of its leaves together reach as far as its own on every axis.
std::string validate(const Bvh& bvh, std::span<const Box3> boxes, Repeats repeats = Repeats::refused);

/// The same for the invariants of wide.h.
template <int W>
std::string validate(const WideBvh<W>& wide, std::span<const Box3> boxes);

extern template std::string validate(const WideBvh<4>&, std::span<const Box3>);
extern template std::string validate(const WideBvh<8>&, std::span<const Box3>);
extern template std::string validate(const WideBvh<16>&, std::span<const Box3>);

}  // namespace boxwood
