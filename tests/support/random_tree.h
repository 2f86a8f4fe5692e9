// random_tree.h: which tree would no builder make?
//
// Any tree whose boxes hold what is below them is a right tree, however bad. This one splits at random places
// and blows its inner boxes up at random: an answer that depends on the tree cannot hide from it.
#pragma once

#include <cstdint>
#include <span>

#include "boxwood/tree/bvh.h"

namespace boxwood::test {

/// Leaves of 1 to `leaf_size` primitives. The root's box is exact, as the queries take the bounds of
/// everything from it.
Bvh random_tree(std::span<const Box3> boxes, std::uint32_t leaf_size, std::uint64_t seed);

}  // namespace boxwood::test
