// quad.h: does a ray cross a quadrilateral?
//
// Two watertight triangles that share the diagonal from a to c, so a mesh of quads has no leaks either, and a
// quad need not be flat.
#pragma once

#include "boxwood/shape/triangle.h"

namespace boxwood {

/// The corners in order around the face. u runs from a to b, v from a to d. `part`: 0 for the half (a, b, c),
/// 1 for (a, c, d).
struct Quad {
  Vec3 a, b, c, d;

  Triangle half(std::uint32_t part) const { return part == 0 ? Triangle{a, b, c} : Triangle{a, c, d}; }

  Box3 box() const {
    Box3 box = half(0).box();
    box.extend(d);
    return box;
  }

  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    Crossing crossing;
    if (intersect_triangle(ray, a, b, c, crossing))
      sink.report(Crossing{crossing.t, crossing.u + crossing.v, crossing.v, 0});
    if (intersect_triangle(ray, a, c, d, crossing))
      sink.report(Crossing{crossing.t, crossing.u, crossing.u + crossing.v, 1});
  }

  Vec3 normal(const PreparedRay&, const Crossing& crossing) const { return half(crossing.part).normal(); }

  Vec3 closest_point(Vec3 p) const;
  bool overlaps(const Box3& box) const { return half(0).overlaps(box) || half(1).overlaps(box); }
};

}  // namespace boxwood
