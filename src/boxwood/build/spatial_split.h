// spatial_split.h: which primitives should stand in several leaves?
//
// A long primitive across the diagonal makes a large box that is mostly empty. Before the build such
// primitives are cut into pieces, each with a box of its own; the tree is then built over the pieces. How
// many cuts a primitive gets depends on how much box area a cut would spare, and cuts lie on planes that
// halve the scene, quarter it and so on, where the builder is likely to split too. Karras and Aila, "Fast
// Parallel Construction of High-Quality Bounding Volume Hierarchies", HPG 2013, section 4.3.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "boxwood/core/box.h"
#include "boxwood/core/id.h"
#include "boxwood/core/parallel.h"

namespace boxwood {

/// The box of the part of a primitive that lies inside `region`: inside the region itself, and so large that
/// no point of that part is outside, after all rounding. The empty box where there is no such part. May be
/// called from several threads at once.
using Clip = std::function<Box3(PrimId, const Box3& region)>;

/// Boxes of pieces, and whose they are. A primitive that is not cut is one piece; each has at least one.
struct Pieces {
  std::vector<Box3> boxes;
  std::vector<PrimId> owners;
};

/// Whether cuts may be worth their price: a line through the scene meets many boxes, and those are mostly of
/// primitives with bulk, not of walls or of an even mesh.
bool may_pay_to_split(std::span<const Box3> boxes, Executor& executor);

/// At most share * boxes.size() cuts, all in primitives with more bulk than the average.
Pieces split_spatially(std::span<const Box3> boxes, const Clip& clip, float share, Executor& executor);

}  // namespace boxwood
