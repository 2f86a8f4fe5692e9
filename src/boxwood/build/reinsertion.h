// reinsertion.h: would a subtree be better off elsewhere?
//
// A top-down builder cannot know what its early splits will cost. Afterwards one can: take a subtree out, let
// its sibling take its parent's place, and look through the tree for the place where putting it back costs
// the least area. Bittner, Hapala and Havran, "Fast Insertion-Based Optimization of Bounding Volume
// Hierarchies", CGF 2013; Meister and Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy
// Optimization", CGF 2018.
//
// Each round looks for the new places of the largest subtrees at the same time, in a tree that nobody
// changes, and then moves them one after the other, the greatest gain first; a move that touches what an
// earlier one changed is left out. So the result does not depend on the threads.
#pragma once

#include "boxwood/build/meter.h"
#include "boxwood/build/raw_bvh.h"
#include "boxwood/core/parallel.h"

namespace boxwood {

struct Reinsertion {
  int rounds = 4;
  float share = 0.003f;       ///< Of all nodes, the largest ones, that each round tries to move.
  int max_depth = kMaxDepth;  ///< A tree that would become deeper stays as it is.
};

/// What a round over a tree of `primitives` counts for at a Meter.
inline std::size_t reinsertion_work(std::size_t primitives) {
  return primitives / 16;
}

/// A tree over the same leaves, its nodes in depth-first order; expects one in that order. Cost: for each
/// subtree that is tried, a search that ends where nothing is to be gained, or after a few hundred nodes.
/// Throws Cancelled.
RawBvh reinsert(RawBvh bvh, const Reinsertion& how, Executor& executor, Meter& meter);

}  // namespace boxwood
