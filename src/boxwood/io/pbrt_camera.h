// pbrt_camera.h: where does a scene want to be seen from, and how large?
//
// pbrt's camera looks along +z with +x to the right and +y up; ours looks along -z. Turning z over is all
// that it takes: a world that pbrt sees mirrored (its transform says so by a negative determinant, or the
// lack of one) stays mirrored.
#pragma once

#include "boxwood/io/pbrt_parser.h"

namespace boxwood::io::pbrt {

/// The camera of a Camera directive under the transform `camera_from_world`; none, with a warning, for kinds
/// that are not supported. Throws FileError for values that make no camera.
std::optional<Camera> make_camera(const Directive& directive, const Affine3& camera_from_world,
                                  Warnings& warnings);

struct PictureSize {
  int width = 0, height = 0;
};

/// The size that a Film directive asks for.
PictureSize picture_size(const Directive& directive);

}  // namespace boxwood::io::pbrt
