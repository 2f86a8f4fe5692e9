// options.h: how should a tree be built?
#pragma once

#include "boxwood/core/parallel.h"
#include "boxwood/core/progress.h"

namespace boxwood {

enum class Method {
  longest_axis,  ///< Halve the longest axis at its middle: the textbook's, easy to follow, uneven trees.
  binned_sah,    ///< Surface area heuristic over equal bins: nearly the best tree, fast to build.
  sweep_sah,     ///< Surface area heuristic over every split of the sorted centers: the judge of the others.
  ploc,          ///< Neighbours merged from the leaves up: the fastest.
};

/// Data; the presets are the choices that were measured.
struct BuildOptions {
  Method method = Method::binned_sah;
  int max_depth = 64;  ///< No node deeper than this; 0 to kMaxDepth. A node there is a leaf of any size.
  int leaf_size = 4;   ///< At least 1. A node of more primitives is split, except at max_depth (longest_axis:
                       ///< and where its rule finds no split); of as many or fewer, it may become a leaf.
  int block_size = 1;  ///< SAH: so many shapes are tested at once, at the cost of one; at least 1.
  int bins = 16;       ///< binned_sah: bins on each axis; 2 to 64.
  float traversal_cost = 1.0f;  ///< SAH: a step over two boxes costs this many shape tests.
  /// After the build, so many times, the largest nodes are put where they cost the least: this share of all
  /// nodes, 0 to 1 (reinsertion.h).
  int reinsertion_rounds = 0;
  float reinsertion_share = 0.003f;
  /// With a clip function: at most so many cuts for each primitive on average, 0 to 4 (spatial_split.h).
  float split_share = 0;
  /// For a scene: its triangles take 28 to 32 bytes each in place of 49 to 60, and rays 1.2 to 1.6 times as
  /// long, 3 times in a large soup (docs/algorithms/wide-trees.md). Answers are the same. Builders have no
  /// use for it.
  bool is_compact = false;
  /// Who works; nullptr means default_executor() (oneTBB). The tree is the same for all.
  Executor* executor = nullptr;
  Progress progress;  ///< Told now and then; returning false throws Cancelled. May be empty.

  static BuildOptions fast();      ///< Shortest time to a usable tree.
  static BuildOptions balanced();  ///< The default.
  static BuildOptions best();      ///< Slowest to build, fastest to trace.
};

}  // namespace boxwood
