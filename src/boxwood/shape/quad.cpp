#include "boxwood/shape/quad.h"

#include "boxwood/shape/vec3d.h"

namespace boxwood {

Vec3 Quad::closest_point(Vec3 p) const {
  using namespace detail;
  const auto distance_squared = [p](Vec3 q) {
    const Vec3d to = widen(q) - widen(p);
    return dot(to, to);
  };
  const Vec3 first = half(0).closest_point(p), second = half(1).closest_point(p);
  return distance_squared(second) < distance_squared(first) ? second : first;
}

}  // namespace boxwood
