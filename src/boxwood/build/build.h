// build.h: how does one get a tree? The front door, and the only switch over methods.
#pragma once

#include <ranges>
#include <span>
#include <vector>

#include "boxwood/build/box_source.h"
#include "boxwood/build/options.h"
#include "boxwood/build/raw_bvh.h"
#include "boxwood/build/spatial_split.h"
#include "boxwood/tree/bvh.h"

namespace boxwood {

/// So many do not fit: a tree of n primitives may need 2n - 1 nodes, and those are numbered with 32 bits.
inline constexpr std::size_t kMaxPrimitives = std::size_t(1) << 31;

/// Builds a tree over `boxes`; primitive i of the tree is boxes[i]. Accepts nothing, one, coincident, flat,
/// huge and tiny boxes; a primitive with an empty box is in the tree but is never found by a box test.
///
/// The tree depends on the boxes and the options only, not on the executor. Throws std::invalid_argument when
/// an option is out of its range, a box is not finite (it names the box; the empty box is allowed), or there
/// are kMaxPrimitives or more; Cancelled when options.progress asks for it. Cost: n log n (longest_axis: n
/// log^2 n); memory: see build_memory_bytes.
Bvh build(std::span<const Box3> boxes, const BuildOptions& options = {});

/// The same tree for whoever does not keep the boxes, in memory that is written once.
RawBvh build_raw(std::size_t count, const BoxSource& source, const BuildOptions& options);

/// The same with spatial splits: `clip` tells the boxes of parts of primitives (spatial_split.h), and those
/// that it pays to cut, up to options.split_share, stand in several leaves: their numbers repeat in prim_ids,
/// though not within one leaf. Where cuts may pay, builds quick trees with and without them and goes on with
/// what has the lower SAH cost. A query that reports crossings one by one must expect each as often. An
/// exception from `clip` is passed on.
Bvh build(std::span<const Box3> boxes, const Clip& clip, const BuildOptions& options);

/// How much memory build() with these options, their executor among them, allocates at most for `count`
/// boxes, its result included; within a factor of two of what it does. With options.split_share: the build
/// with a clip function.
std::size_t build_memory_bytes(std::size_t count, const BuildOptions& options);

/// The boxes of a range of shapes, in order.
template <std::ranges::input_range Shapes>
std::vector<Box3> boxes(const Shapes& shapes) {
  std::vector<Box3> out;
  if constexpr (std::ranges::sized_range<const Shapes>) out.reserve(std::ranges::size(shapes));
  for (const auto& shape : shapes) out.push_back(shape.box());
  return out;
}

}  // namespace boxwood
