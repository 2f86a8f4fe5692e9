// traverse.h: how does any question walk a tree?
//
// One loop for all of them. A query offers a lower bound for a box, a limit that only shrinks, and a visit;
// the loop goes to the nearer child first, keeps the farther one for later, and skips whatever lies beyond
// the limit.
#pragma once

#include <concepts>
#include <utility>

#include "boxwood/tree/bvh.h"

namespace boxwood {

/// Laws: the bound of a box is at most the bound of any box inside it; bound <= limit is "may matter", so a
/// tie is still visited; limit() never grows during one walk.
template <class Q>
concept Query = requires(Q query, const Box3& box, PrimId id) {
  { query.bound(box) } -> std::same_as<float>;  // nothing inside the box is better than this; +inf: skip it
  { query.limit() } -> std::same_as<float>;     // anything above this no longer matters
  {query.visit(id)};                            // look at one primitive
};

/// Counts what a walk did; pass it to traverse to have it filled (see also NoStatistics).
struct TraversalStatistics {
  std::uint64_t box_tests = 0, shape_tests = 0;
  void count_boxes(int n) { box_tests += n; }
  void count_shapes(std::uint32_t n) { shape_tests += n; }
};

/// Counts nothing, and costs nothing.
struct NoStatistics {
  void count_boxes(int) {}
  void count_shapes(std::uint32_t) {}
};

/// Shows every primitive that may matter to `query`.
/// Allocates nothing; any number of threads may walk one tree.
template <Query Q, class Statistics>
void traverse(const Bvh& bvh, Q& query, Statistics& statistics) {
  if (bvh.is_empty()) return;
  struct Postponed {
    std::uint32_t node_index;
    float bound;
  };
  Postponed stack[kMaxDepth + 1];
  int waiting = 0;

  // An infinite bound means "skip", whatever the limit is.
  const auto matters = [&query](float bound) { return bound < kInfinity && bound <= query.limit(); };
  statistics.count_boxes(1);
  if (!matters(query.bound(bvh.nodes[0].box))) return;
  std::uint32_t node_index = 0;

  while (true) {
    const BvhNode& node = bvh.nodes[node_index];
    if (node.is_leaf()) {
      // Look at the primitives.
      statistics.count_shapes(node.count);
      for (std::uint32_t i = 0; i < node.count; ++i) query.visit(bvh.prim_ids[node.first_index + i]);
    } else {
      // Go to the nearer child; remember the farther one.
      statistics.count_boxes(2);
      Postponed near{node.first_index, query.bound(bvh.nodes[node.first_index].box)};
      Postponed far{node.first_index + 1, query.bound(bvh.nodes[node.first_index + 1].box)};
      if (far.bound < near.bound) std::swap(near, far);
      if (matters(far.bound)) stack[waiting++] = far;
      if (matters(near.bound)) {
        node_index = near.node_index;
        continue;
      }
    }

    // Take the last postponed node that still matters.
    do {
      if (waiting == 0) return;
      --waiting;
    } while (!(stack[waiting].bound <= query.limit()));
    node_index = stack[waiting].node_index;
  }
}

template <Query Q>
void traverse(const Bvh& bvh, Q& query) {
  NoStatistics none;
  traverse(bvh, query, none);
}

}  // namespace boxwood
