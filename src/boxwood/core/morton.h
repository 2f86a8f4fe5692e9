// morton.h: which points are neighbours, in one number?
//
// Cut a box into 2^b cells on each axis and interleave the bits of a point's three cell numbers, x lowest:
// points with close codes are close in space, and a sort by code walks the cells along a Z-shaped curve
// (Morton, "A Computer Oriented Geodetic Data Base", IBM 1966). The prefix of a code names a box, which is
// what linear builders build on.
#pragma once

#include "boxwood/core/box.h"

namespace boxwood {

/// The bits of `x` at every third place, the lowest one at 0;
/// of x the lower 10 (32-bit) or 21 (64-bit) bits count.
constexpr std::uint32_t spread_bits_by_3(std::uint32_t x) {
  // Each step moves the upper half of every group twice the group's length away.
  x &= 0x3ff;
  x = (x | x << 16) & 0x030000ff;
  x = (x | x << 8) & 0x0300f00f;
  x = (x | x << 4) & 0x030c30c3;
  x = (x | x << 2) & 0x09249249;
  return x;
}
constexpr std::uint64_t spread_bits_by_3(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

/// Which of `cells` equal parts of [lower, upper] holds x: 0 to cells - 1. Never falls as x grows. Outside
/// goes to the nearest part; NaN, an empty and a flat range go to part 0. In double, where no range of floats
/// overflows.
constexpr std::uint32_t cell_of(float x, float lower, float upper, std::uint32_t cells) {
  const double place = (double(x) - lower) / (double(upper) - lower) * cells;
  if (!(upper > lower) || !(place > 0)) return 0;
  return place < cells ? static_cast<std::uint32_t>(place) : cells - 1;
}

/// The 30-bit code of `p` in `box`, 10 bits an axis.
constexpr std::uint32_t morton30(Vec3 p, const Box3& box) {
  std::uint32_t code = 0;
  for (int k = 0; k < 3; ++k)
    code |= spread_bits_by_3(cell_of(p[k], box.lower[k], box.upper[k], 1u << 10)) << k;
  return code;
}

/// The 63-bit code of `p` in `box`, 21 bits an axis. Its highest bits are those of morton30.
constexpr std::uint64_t morton63(Vec3 p, const Box3& box) {
  std::uint64_t code = 0;
  for (int k = 0; k < 3; ++k)
    code |= spread_bits_by_3(std::uint64_t(cell_of(p[k], box.lower[k], box.upper[k], 1u << 21))) << k;
  return code;
}

}  // namespace boxwood
