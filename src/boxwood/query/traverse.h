// traverse.h: how does any question walk a tree?
//
// One loop for all of them. A query offers a lower bound for a box, a limit that only shrinks, and a visit;
// the loop goes to the nearer child first, keeps the farther one for later, and skips whatever lies beyond
// the limit.
#pragma once

#include <concepts>
#include <limits>

#include "boxwood/core/prefetch.h"
#include "boxwood/core/prepared_ray.h"
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

/// A query that knows the bounds of two boxes sooner together, as a ray does: what it would say of each, and
/// what they must not exceed to matter.
template <class Q>
concept QueryOfPairs = Query<Q> && requires(Q query, const Box3& box) {
  { query.parts(box, box) } -> std::same_as<PreparedRay::TwoIntervals>;
};

namespace detail {

/// The bounds of two boxes; one matters that is no larger than its end.
struct TwoBounds {
  float left, right, left_end, right_end;
};
template <Query Q>
BOXWOOD_ALWAYS_INLINE TwoBounds two_bounds(Q& query, const Box3& left, const Box3& right) {
  if constexpr (QueryOfPairs<Q>) {
    const PreparedRay::TwoIntervals in = query.parts(left, right);
    return {in.entry.v[0], in.entry.v[1], in.exit.v[0], in.exit.v[1]};
  } else {
    // An infinite bound means "skip", whatever the limit is.
    const float end = min(query.limit(), std::numeric_limits<float>::max());
    return {query.bound(left), query.bound(right), end, end};
  }
}

}  // namespace detail

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

  statistics.count_boxes(1);
  const float bound = query.bound(bvh.nodes[0].box);
  if (!(bound < kInfinity && bound <= query.limit())) return;
  std::uint32_t node_index = 0;

  while (true) {
    const BvhNode& node = bvh.nodes[node_index];
    if (node.is_leaf()) {
      // Look at the primitives.
      statistics.count_shapes(node.count);
      for (std::uint32_t i = 0; i < node.count; ++i) query.visit(bvh.prim_ids[node.first_index + i]);
    } else {
      // Ask for what lies below both children: whether a branch is foreseen or not, it is on its way.
      statistics.count_boxes(2);
      const std::uint32_t left = node.first_index, right = left + 1;
      const BvhNode* const children = &bvh.nodes[left];
      prefetch(bvh.nodes.data() + children[0].first_index);
      prefetch(bvh.nodes.data() + children[1].first_index);

      // Go to the nearer child; remember the farther one.
      const detail::TwoBounds bounds = detail::two_bounds(query, children[0].box, children[1].box);
      if (bounds.left <= bounds.left_end) {
        if (!(bounds.right <= bounds.right_end)) {
          node_index = left;
        } else if (bounds.right < bounds.left) {
          stack[waiting++] = {left, bounds.left};
          node_index = right;
        } else {
          stack[waiting++] = {right, bounds.right};
          node_index = left;
        }
        continue;
      }
      if (bounds.right <= bounds.right_end) {
        node_index = right;
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
