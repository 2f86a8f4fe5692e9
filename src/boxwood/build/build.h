// build.h: how does one get a tree? The front door, and the only switch over methods.
#pragma once

#include <ranges>
#include <span>
#include <vector>

#include "boxwood/build/options.h"
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
/// log^2 n); memory up to 200 bytes a box while it runs.
Bvh build(std::span<const Box3> boxes, const BuildOptions& options = {});

/// The boxes of a range of shapes, in order.
template <std::ranges::input_range Shapes>
std::vector<Box3> boxes(const Shapes& shapes) {
  std::vector<Box3> out;
  if constexpr (std::ranges::sized_range<const Shapes>) out.reserve(std::ranges::size(shapes));
  for (const auto& shape : shapes) out.push_back(shape.box());
  return out;
}

}  // namespace boxwood
