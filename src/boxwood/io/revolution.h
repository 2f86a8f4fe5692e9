// revolution.h: which triangles make a surface of revolution?
//
// pbrt has a shape for each of the classic quadrics and for their parts. What is not a whole sphere or disk
// is cut into triangles here, fine enough for the eye; normals are those of the true surface.
#pragma once

#include <functional>

#include "boxwood/scene/description.h"

namespace boxwood::io {

/// A point of a profile: its distance from the z axis, its height, and the same of the outward normal.
struct ProfilePoint {
  float radius, height;
  float normal_radius, normal_height;
};

/// The profile, a function of v in [0, 1], turned around the z axis from 0 to `phi_max` (radians, at most 2
/// pi). `steps` is how many pieces the profile is cut into; the turn is cut into 64 for a whole circle. u is
/// the share of the turn.
TriangleMesh revolve(const std::function<ProfilePoint(float v)>& profile, float phi_max, int steps);

}  // namespace boxwood::io
