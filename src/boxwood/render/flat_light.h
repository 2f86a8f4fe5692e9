// flat_light.h: how do many points each try a point of a flat light?
//
// Triangles and parallelograms of one color, what most lamps are made of, take arithmetic and selects only,
// so a block of points (block.h) is worked on by vectors. All in world space.
#pragma once

#include <vector>

#include "boxwood/render/light_sample.h"
#include "boxwood/scene/surface_block.h"

namespace boxwood::render {

/// A light whose points are drawn uniformly by area.
struct FlatLight {
  Vec3 corner, x, y;       ///< The edges that start at the corner.
  Vec3 normal;             ///< Of the front.
  Vec3 radiance;           ///< From the front.
  float density = 0;       ///< Of its points, per area.
  float clearance = 0;     ///< How far along the normal a ray to it has to end.
  float is_triangle = 0;   ///< 1, or 0 for a parallelogram.
  float is_two_sided = 0;  ///< 1, or 0.
};

/// Each point tries the light of its index, chosen with its probability, at the point that `u` picks.
void sample_flat_lights(const std::vector<FlatLight>& lights, const Integers& index,
                        const Floats& probability, const SurfaceBlock& from, const Vec2s& u,
                        LightSamples& out);

}  // namespace boxwood::render
