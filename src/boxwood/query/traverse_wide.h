// traverse_wide.h: how does any question walk a tree of many children a node?
//
// The loop of traverse.h, one rank wider: all children of a node are asked for their bounds at once, those
// that may matter are put on the stack with the nearest on top, and the walk goes on from there. A query
// visits whole leaves, because only it knows what the blocks of a leaf are made of.
#pragma once

#include "boxwood/query/traverse.h"
#include "boxwood/tree/wide.h"

namespace boxwood {

/// As Query, with the same laws; `leaf` is the reference by which the tree names a leaf.
template <class Q>
concept WideQuery = requires(Q query, const Box3& box, ChildRef leaf) {
  { query.bound(box) } -> std::same_as<float>;  // nothing inside the box is better than this; +inf: skip it
  { query.limit() } -> std::same_as<float>;     // anything above this no longer matters
  {query.visit(leaf)};                          // look at the blocks of one leaf
};

/// Shows every leaf that may matter to `query`; node_at(reference) is the node that a reference names, and
/// node 0 is the root. Precondition: the tree is not empty. Counts boxes only: what a leaf holds, the query
/// knows. Allocates nothing; any number of threads may walk one tree.
template <int W, class NodeAt, WideQuery Q, class Statistics>
void traverse_wide(const NodeAt& node_at, Q& query, Statistics& statistics) {
  struct Postponed {
    ChildRef ref;
    float bound;
  };
  Postponed stack[kMaxWideStack<W>];
  int waiting = 0;
  ChildRef current = ChildRef::node(0);

  while (true) {
    if (current.is_leaf()) {
      query.visit(current);
    } else {
      // Put the children that may matter on the stack, the nearest last; of equals the first stays on top.
      const auto& node = node_at(current);  // in full or quantized
      const float limit = query.limit();
      const int bottom = waiting;
      int tests = 0;
      for (int c = W - 1; c >= 0; --c) {
        if (node.children[c].is_empty()) continue;
        ++tests;
        const float bound = query.bound(node.box(c));
        if (!(bound < kInfinity && bound <= limit)) continue;
        int place = waiting++;
        for (; place > bottom && stack[place - 1].bound < bound; --place) stack[place] = stack[place - 1];
        stack[place] = {node.children[c], bound};
      }
      statistics.count_boxes(tests);
    }

    // Take the last postponed child that still matters.
    do {
      if (waiting == 0) return;
      --waiting;
    } while (!(stack[waiting].bound <= query.limit()));
    current = stack[waiting].ref;
  }
}

}  // namespace boxwood
