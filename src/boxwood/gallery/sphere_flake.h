// sphere_flake.h: how does a ball of balls grow?
//
// The sphere flake of Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A, 1987: every sphere
// carries nine smaller ones, a third as large, six around its equator and three above; the equator is turned
// to face away from the parent. Level k has 9^k spheres.
#pragma once

#include <vector>

#include "boxwood/shape/sphere.h"

namespace boxwood::gallery {

/// A flake of `levels` levels, the root included: (9^levels - 1) / 8 spheres, the root first. All of it lies
/// within twice the radius of the center. `up` is of unit length. Precondition: levels >= 1.
std::vector<Sphere> sphere_flake(Vec3 center, float radius, Vec3 up, int levels);

}  // namespace boxwood::gallery
