#include "boxwood/gallery/sphere_flake.h"

namespace boxwood::gallery {

namespace {

/// Where the children sit, as unit vectors of (tangent, bitangent, up): six on the equator, 60 degrees apart,
/// and three half-way to the pole, 120 degrees apart and above the gaps.
constexpr float kHalf = 0.5f, kSin60 = 0.8660254f, kSin45 = 0.70710678f;
constexpr Vec3 kSeats[9] = {
    {1, 0, 0},
    {kHalf, kSin60, 0},
    {-kHalf, kSin60, 0},
    {-1, 0, 0},
    {-kHalf, -kSin60, 0},
    {kHalf, -kSin60, 0},
    {0, kSin45, kSin45},
    {-kSin45 * kSin60, -kSin45* kHalf, kSin45},
    {kSin45 * kSin60, -kSin45* kHalf, kSin45},
};

void grow(std::vector<Sphere>& spheres, Vec3 center, float radius, Vec3 up, int levels) {
  spheres.push_back({center, radius});
  if (levels == 1) return;
  Vec3 tangent, bitangent;
  orthonormal_basis(up, tangent, bitangent);
  for (const Vec3 seat : kSeats) {
    const Vec3 outward = tangent * seat.x + bitangent * seat.y + up * seat.z;
    grow(spheres, center + outward * (radius * 4 / 3), radius / 3, outward, levels - 1);
  }
}

}  // namespace

std::vector<Sphere> sphere_flake(Vec3 center, float radius, Vec3 up, int levels) {
  std::vector<Sphere> spheres;
  grow(spheres, center, radius, up, levels);
  return spheres;
}

}  // namespace boxwood::gallery
