// environment_map.h: which light does a picture of the surroundings hold?
//
// Pictures twice as wide as high hold longitudes and latitudes. Square ones, which version 4 of pbrt writes,
// fold the sphere into a square so that equal areas stay equal: Clarberg, "Fast Equal-Area Mapping of the
// (Hemi)Sphere using SIMD", JGT 2008. They are drawn anew by longitude and latitude.
#pragma once

#include <array>
#include <filesystem>

#include "boxwood/scene/image.h"

namespace boxwood::io {

/// Reads a picture for Environment::radiance: three channels, by longitude and latitude. Pixels that are
/// negative or not finite become black, and are counted in `mended`. Throws FileError.
Image read_environment(const std::filesystem::path& path, std::size_t& mended);

/// Where in the square, in [0, 1]^2, the unit vector `direction` is.
std::array<double, 2> equal_area_square(std::array<double, 3> direction);

}  // namespace boxwood::io
