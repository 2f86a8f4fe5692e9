// leak_rays.h: which rays are the likeliest to slip through a closed mesh?
//
// Those aimed at its vertices and edges, from inside and from outside. From inside every ray must hit;
// counted as -1 where it enters and +1 where it leaves, its crossings sum to 1 from inside and to 0 from
// outside, which a crossing that is lost or found twice upsets.
#pragma once

#include <string>
#include <vector>

#include "boxwood/core/prepared_ray.h"
#include "boxwood/core/random.h"
#include "support/meshes.h"

namespace boxwood::test {

/// A closed mesh in about [-1, 1]^3, with a ball well inside of it.
struct Body {
  std::string name;
  test::Mesh mesh;
  Vec3 inside;
  float clearance;
};

const std::vector<Body>& bodies();

/// Where the bodies are put: the farther off, the coarser the floats.
inline constexpr Vec3 kOffsets[] = {{0, 0, 0}, {1e3f, -1e3f, 1e3f}, {-1e4f, 1e4f, 1e4f}};

/// A ray with what must be true of it.
struct AimedRay {
  Ray ray;
  bool starts_inside, must_hit;
};

/// A random ray at `mesh`, about `size` across, which holds the ball of radius `clearance` around `inside`.
AimedRay aim(const Mesh& mesh, Vec3 inside, float clearance, float size, Random& random);

/// +1 where the ray leaves through the triangle, -1 where it enters:
/// the sign of the area that the crossing test saw.
int crossing_sign(const RayShear& ray, const Triangle& triangle);

}  // namespace boxwood::test
