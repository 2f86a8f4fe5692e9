// face_area.h: how much of the surface of a box lies inside another box?
#pragma once

#include "boxwood/core/box.h"

namespace boxwood {

/// The area of those parts of the faces of `box` that lie inside `clip`, borders included.
inline double face_area_inside(const Box3& box, const Box3& clip) {
  const Box3 common = intersect(box, clip);
  if (common.is_empty()) return 0;
  double extent[3];
  for (int k = 0; k < 3; ++k) extent[k] = double(common.upper[k]) - common.lower[k];
  double area = 0;
  for (int k = 0; k < 3; ++k) {
    const int faces = (common.lower[k] == box.lower[k]) + (common.upper[k] == box.upper[k]);
    area += faces * extent[(k + 1) % 3] * extent[(k + 2) % 3];
  }
  return area;
}

}  // namespace boxwood
