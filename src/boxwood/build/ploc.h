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
#include "boxwood/build/morton_order.h"
#include "boxwood/build/nearest.h"
#include "boxwood/build/top_down.h"

namespace boxwood {

/// Makes all clusters, then writes them down as a tree. Cost: linear. Where they lie deeper than is allowed,
/// the driver (top_down.h) does that, and halves ranges in the clusters' own order.
class PlocSplitter {
 public:
  struct Share {
    std::uint32_t cluster;  ///< A pair, or behind all pairs a group of the order.
    bool is_list = false;   ///< A part of a range that was halved: see list_.
  };

  /// Throws Cancelled.
  PlocSplitter(const Items& items, const BuildOptions& options, Executor& executor, Meter& meter);

  /// Levels below the root.
  int height() const { return is_group(root_) ? 0 : pairs_[root_].height; }
  /// The clusters as a tree, in depth-first order; each cluster knows how many nodes it takes. Precondition:
  /// there is at least one item.
  RawBvh tree(Executor& executor, Meter& meter) const;

  Share root() const { return {root_}; }
  Step<Share> step(Range range, Plan plan, const Share& share);
  void write_leaf(Range range, const Share& share, std::span<PrimId> out) const;

 private:
  /// Two clusters that became one.
  struct Pair {
    Box3 box;
    std::uint32_t left, right;
    std::uint32_t count;  ///< Primitives.
    float cost;           ///< SAH, areas as in Scale; known where a leaf could hold them.
    std::uint32_t nodes_below;
    std::uint8_t height;  ///< Levels below; 255 also stands for more.
    bool is_leaf;         ///< Few enough, and better tested all at once.
  };
  /// Where a subtree is written: its descendants from node `base` on, its primitives from `first_prim` on.
  struct Slot {
    std::uint32_t base, first_prim;
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
  void write_subtree(RawBvh& bvh, std::uint32_t node_index, std::uint32_t cluster, Slot slot,
                     Executor& executor, Meter& meter) const;
  void write_small(RawBvh& bvh, std::uint32_t node_index, std::uint32_t cluster, Slot slot) const;
  Box3 box_of(std::span<const PrimId> ids) const;
  /// Writes the primitives below a cluster, from left to right; returns the place behind the last.
  PrimId* write_members(std::uint32_t cluster, PrimId* out) const;

  const Items& items_;
  const std::uint32_t leaf_size_;
  const SahCost cost_;
  const Scale scale_;
  MortonOrder order_;
  RawArray<Pair> pairs_;
  std::uint32_t root_ = 0;
  RawArray<PrimId> list_;  ///< By position in the tree; written where a range is halved.
};

}  // namespace boxwood
