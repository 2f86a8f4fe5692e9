#include "boxwood/shape/instance.h"

namespace boxwood {

bool is_similarity(const Affine3& map) {
  // The columns are orthogonal and of one length;
  // a rotation in floats is so to a few units in the last place.
  using namespace detail;
  const Vec3d x = widen(map.x), y = widen(map.y), z = widen(map.z);
  const double size2 = dot(x, x), slack = size2 * 0x1p-18;
  return size2 > 0 && std::fabs(dot(y, y) - size2) <= slack && std::fabs(dot(z, z) - size2) <= slack &&
         std::fabs(dot(x, y)) <= slack && std::fabs(dot(y, z)) <= slack && std::fabs(dot(z, x)) <= slack;
}

}  // namespace boxwood
