// ploc.h: which two clusters belong together?
//
// From the leaves up: bring the primitives into Morton order, look for each cluster's nearest neighbour among
// the few before and behind it (the one with which it has the smallest box), merge all pairs that choose each
// other, and repeat until one is left. Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding
// Volume Hierarchy Construction", IEEE TVCG 2018.
//
// Our deviations. Neighbours that are tested as one block are the first clusters. The order is cut into
// chunks that fit the first cache; each is worked on by itself until few clusters are left, which then make
// up the chunks of the next phase. Ties are broken as nearest.h says.
#pragma once

#include "boxwood/build/cost.h"
#include "boxwood/build/meter.h"
#include "boxwood/build/morton_order.h"
#include "boxwood/build/nearest.h"
#include "boxwood/build/options.h"
#include "boxwood/build/raw_bvh.h"

namespace boxwood {

/// Makes all clusters, then writes them down as a tree. Cost: linear.
class PlocBuilder {
 public:
  /// Throws Cancelled.
  PlocBuilder(const Items& items, const BuildOptions& options, Executor& executor, Meter& meter);

  /// The clusters as a tree, in depth-first order; `empty_boxes` have a subtree of their own. Where clusters
  /// lie deeper than options.max_depth, ranges are halved in the clusters' own order; only then boxes are
  /// asked for once more.
  RawBvh tree(std::span<const PrimId> empty_boxes, const BoxSource& source, Executor& executor, Meter& meter);

 private:
  /// Two clusters that became one.
  struct Pair {
    Box3 box;
    std::uint32_t left, right;
    std::uint32_t count;        ///< Primitives.
    float cost;                 ///< SAH, areas as in Scale; known where a leaf could hold them.
    std::uint32_t nodes_below;  ///< In the tree.
    std::uint8_t height;        ///< Levels below; 255 also stands for more.
    enum class Kind : std::uint8_t { pair, leaf, halved } kind;
  };
  /// Where a subtree is written: its root, its descendants from node `base` on, its primitives from
  /// `first_prim` on.
  struct Slot {
    std::uint32_t node_index, base, first_prim;
  };
  class Row;

  void merge_all(Executor& executor, Meter& meter);
  void fill(Row& row, const std::uint32_t* clusters, std::uint32_t count) const;
  void merge_chunk(Row& row, std::uint32_t enough, std::uint32_t first_pair);

  bool is_group(std::uint32_t cluster) const { return cluster >= pairs_.size(); }
  const Group& group(std::uint32_t cluster) const { return order_.groups[cluster - pairs_.size()]; }
  std::uint32_t count_of(std::uint32_t cluster) const {
    return is_group(cluster) ? size_of(group(cluster)) : pairs_[cluster].count;
  }
  std::uint32_t nodes_below(std::uint32_t cluster) const {
    return is_group(cluster) ? 0 : pairs_[cluster].nodes_below;
  }
  int height_of(std::uint32_t cluster) const { return is_group(cluster) ? 0 : pairs_[cluster].height; }

  /// Decides where ranges are halved so that no node lies more than `levels` below the cluster; counts nodes
  /// anew.
  void keep_within(std::uint32_t cluster, int levels);
  std::uint32_t nodes_below_halved(std::uint32_t count, int levels) const;
  /// Writes the subtree of a cluster, whose root has `levels` below it at most.
  void write(RawBvh& bvh, std::uint32_t cluster, Slot slot, int levels, const BoxSource& source,
             Executor& executor, Meter& meter) const;
  void write_small(RawBvh& bvh, std::uint32_t cluster, Slot slot, int levels, const BoxSource& source) const;
  /// Halves the primitives that stand at their places already. An empty source: none of them has a box.
  Box3 write_halved(RawBvh& bvh, std::uint32_t count, Slot slot, int levels, const BoxSource& source) const;
  /// Writes the primitives below a cluster, from left to right; returns the place behind the last.
  PrimId* write_members(std::uint32_t cluster, PrimId* out) const;

  const std::uint32_t leaf_size_;
  const int max_depth_;
  const SahCost cost_;
  const Scale scale_;
  MortonOrder order_;
  RawArray<Pair> pairs_;
  std::uint32_t root_ = 0;
};

}  // namespace boxwood
