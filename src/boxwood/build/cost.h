// cost.h: what does a split cost?
//
// The surface area heuristic (Goldsmith and Salmon, "Automatic Creation of Object Hierarchies for Ray
// Tracing", 1987; MacDonald and Booth, "Heuristics for Ray Tracing Using Space Subdivision", 1990). A random
// line that meets a convex box meets a convex box inside it with the probability area(inside) /
// area(outside). So, in units of one shape test:
//
//     leaf:   N(n) = ceil(n / b)                           tests of b primitives at a time
//     split:  traversal + (A_left N(n_left) + A_right N(n_right)) / A
//
// where both halves are taken for leaves: a guess from above, the same for all candidates. Where shapes are
// tested by vectors, b is their width, and three primitives cost as much as four (Wald, Benthin and Boulos,
// "Getting Rid of Packets", IEEE RT 2008). Here everything is multiplied by A, so that a flat or tiny node
// needs no division. sah_cost (tree/metrics.h) sums the same over a finished tree, with b = 1.
#pragma once

#include <cstdint>

#include "boxwood/core/lanes.h"

namespace boxwood {

/// Areas are half areas (core/box.h).
struct SahCost {
  double traversal;     ///< One step over an interior node, that is two box tests, in shape tests.
  std::uint32_t block;  ///< b

  std::uint32_t tests(std::uint32_t count) const { return block == 1 ? count : (count + block - 1) / block; }
  /// The same for the counts on three axes.
  Lanes tests(Lanes counts) const {
    if (block == 1) return counts;
    return floor_of((counts + Lanes::all(float(block - 1))) * Lanes::all(1.0f / float(block)));
  }
  double leaf(double area, std::uint32_t count) const { return area * tests(count); }
  /// What remains below a step: the part that a search for the best split minimizes.
  double children(double left_area, std::uint32_t left_count, double right_area,
                  std::uint32_t right_count) const {
    return left_area * tests(left_count) + right_area * tests(right_count);
  }
  double split(double area, double children_cost) const { return traversal * area + children_cost; }
};

/// A way to split a node, with its price; of several the best one. Default: none.
struct Split {
  double children_cost = 0;
  std::uint32_t unevenness = 0;  ///< By how many primitives one side is larger.
  int axis = -1;                 ///< -1: no split.
  std::uint32_t index = 0;       ///< Which candidate on that axis, in the builder's own terms.

  bool exists() const { return axis >= 0; }
  /// Equal prices go to the more even split, which is what keeps a node without area in balance (points on a
  /// line, coincident boxes); then to the one that came first.
  bool is_better_than(const Split& other) const {
    if (!exists() || !other.exists()) return exists() && !other.exists();
    if (children_cost != other.children_cost) return children_cost < other.children_cost;
    return unevenness < other.unevenness;
  }
};

inline std::uint32_t difference(std::uint32_t a, std::uint32_t b) {
  return a > b ? a - b : b - a;
}

}  // namespace boxwood
