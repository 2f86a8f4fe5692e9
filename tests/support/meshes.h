// meshes.h: which bodies do the tests trace rays against?
//
// Closed meshes share their vertices bit for bit and are wound counter-clockwise seen from outside, so every
// ray crosses them an even number of times. Everything repeats exactly for equal arguments.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "boxwood/shape/triangle.h"

namespace boxwood::test {

struct Mesh {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> indices;
};

/// The unit sphere: an icosahedron whose faces are cut in four `levels` times; 20 * 4^levels triangles.
Mesh icosphere(int levels);
/// Around the z axis, with ring radius 1 and tube radius 0.4; 2 * around * across triangles.
Mesh torus(int around, int across);
/// The block [-1, 1]^3 with each face cut into cells * cells squares; 12 * cells^2 triangles.
Mesh cube(int cells = 1);
/// Menger's sponge in [-1, 1]^3: a closed fractal solid, full of edges inside edges and of faces in one
/// plane. Level 0 is the cube; level 3 has 36,096 triangles.
Mesh sponge(int levels);
/// An icosphere whose vertices are moved in and out by random amounts,
/// at every level by half as much as before.
Mesh rough_sphere(int levels, std::uint64_t seed = 1);
/// `count` separate triangles in [-1, 1]^3; sizes from 1 down to 1e-4, spread evenly over the magnitudes.
Mesh triangle_soup(int count, std::uint64_t seed = 1);

/// The mesh scaled about the origin and then moved.
Mesh placed(Mesh mesh, float scale, Vec3 offset);
std::vector<Triangle> triangles(const Mesh& mesh);
/// Whether every edge is run along as often one way as the other.
bool is_closed(const Mesh& mesh);

}  // namespace boxwood::test
