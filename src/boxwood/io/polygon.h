// polygon.h: which triangles fill this polygon?
//
// A fan when the polygon is convex, else ear clipping (Meisters, "Polygons Have Ears", 1975) in the plane of
// the polygon's Newell normal. Polygons of files need be neither flat nor simple: whatever comes in, n
// corners give n - 2 triangles of the same orientation as the polygon's own order.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "boxwood/core/vec.h"

namespace boxwood::io {

/// Appends corners.size() - 2 triangles to `triangles`, nothing when there are fewer than 3 corners. Every
/// corner is a position in `positions`. Takes O(n) for convex polygons and about O(n^2) for concave ones, of
/// which those with more than a thousand corners get a fan.
void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
                 std::vector<std::array<std::uint32_t, 3>>& triangles);

/// The same for corners that are not vertices yet: fills `triangles` with positions in `outline`.
void triangulate_outline(std::span<const Vec3> outline, std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace boxwood::io
