// cuboid.h: does a ray cross an axis-aligned block?
//
// The slab method of Kay and Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986, in double. The line of a
// ray meets the surface twice or not at all, so the number of crossings is always even.
#pragma once

#include "boxwood/shape/concept.h"

namespace boxwood {

/// The surface of the block between two corners. `part`: the face, 2 * axis for the lower one, 2 * axis + 1
/// for the upper. Never hit when lower > upper on some axis; may be flat.
struct Cuboid {
  Vec3 lower, upper;

  Box3 box() const {
    const Box3 box{lower, upper};
    return box.is_empty() ? Box3{} : box;
  }

  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    double entry = -kInfinity, exit = kInfinity;
    std::uint32_t entry_face = 0, exit_face = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const int axis = static_cast<int>(k);
      const double o = ray.origin[axis], d = ray.direction[axis];
      if (!(lower[axis] <= upper[axis])) return;
      if (d == 0) {  // inside this slab for ever, or never
        if (o < lower[axis] || o > upper[axis]) return;
        continue;
      }
      const bool forward = d > 0;
      const double t_near = ((forward ? lower[axis] : upper[axis]) - o) / d;
      const double t_far = ((forward ? upper[axis] : lower[axis]) - o) / d;
      if (t_near > entry) entry = t_near, entry_face = 2 * k + (forward ? 0 : 1);
      if (t_far < exit) exit = t_far, exit_face = 2 * k + (forward ? 1 : 0);
    }
    if (!(entry <= exit)) return;
    report(static_cast<float>(entry), entry_face, sink);
    report(static_cast<float>(exit), exit_face, sink);
  }

  Vec3 normal(const PreparedRay&, const Crossing& crossing) const {
    Vec3 n{0, 0, 0};
    n[static_cast<int>(crossing.part / 2)] = crossing.part % 2 ? 1.0f : -1.0f;
    return n;
  }

  Vec3 closest_point(Vec3 p) const;
  bool overlaps(const Box3& other) const;

 private:
  template <class Sink>
  static void report(float t, std::uint32_t face, Sink& sink) {
    if (std::fabs(t) < kInfinity) sink.report(Crossing{t, 0, 0, face});
  }
};

}  // namespace boxwood
