// ray.h: what is asked?
#pragma once

#include "boxwood/core/box.h"

namespace boxwood {

/// The points origin + t * direction with t in [t_min, t_max], both included.
///
/// The direction need not be a unit vector; t is measured in multiples of it. A t_min below 0 counts as 0. A
/// ray that has a NaN anywhere, an infinite origin or direction, a direction whose largest component is
/// outside [2^-96, 2^96], or t_min > t_max, hits nothing. The eight floats lie in memory as they stand here.
struct Ray {
  Vec3 origin;
  float t_min = 0;
  Vec3 direction;
  float t_max = kInfinity;

  constexpr Vec3 at(float t) const { return origin + direction * t; }
};
static_assert(sizeof(Ray) == 32);

}  // namespace boxwood
