// raw_bvh.h: how does a tree lie in memory while it is made?
//
// As a Bvh (tree/bvh.h), with the same invariants, in memory that is written once.
#pragma once

#include "boxwood/core/raw_array.h"
#include "boxwood/tree/bvh.h"

namespace boxwood {

struct RawBvh {
  RawArray<BvhNode> nodes;
  RawArray<PrimId> prim_ids;

  BvhView view() const { return {{nodes.data(), nodes.size()}, {prim_ids.data(), prim_ids.size()}}; }
};

}  // namespace boxwood
