// nearest.h: with which of the boxes around it in a row does a box make the smallest one?
//
// The inner loop of clustering (ploc.h), for every CPU and for those with AVX2; both give the same answer.
#pragma once

#include <cstdint>

#include "boxwood/build/item.h"

namespace boxwood {

/// How far a box looks to each side.
inline constexpr int kReach = 8;

/// Boxes in a row, one array for each plane: -lower x, y, z, upper x, y, z. There must be kReach boxes more
/// before the first and 2 kReach behind the last, which are so large that nobody wants them.
struct BoxRow {
  float* plane[6];
  std::uint32_t count;
};

/// partner[i]: the position of the box that makes the smallest box with box i. The choice is such that there
/// are always two that choose each other: a union's size counts for both alike, nearer boxes win ties, and
/// equally near ones by a rule under which (0, 1), (2, 3), ... find each other. The size is the half area,
/// relative to `scale` (item.h).
void find_nearest(const BoxRow& row, const Scale& scale, std::uint16_t* partner);

}  // namespace boxwood
