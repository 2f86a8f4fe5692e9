// pbrt_camera.h: where does a scene want to be seen from, and how large?
//
// pbrt's camera looks along +z with +x to the right and +y up; ours looks along -z. Turning z over is all
// that it takes: a world that pbrt sees mirrored (its transform says so by a negative determinant, or the
// lack of one) stays mirrored.
#pragma once

#include "boxwood/io/pbrt_parser.h"

namespace boxwood::io::pbrt {

/// The camera of a Camera directive under the transform `camera_from_world`. For kinds that are not supported
/// a plain one in their place, with the angle of the camera before it and a warning. Throws FileError for
/// values that make no camera.
Camera make_camera(const Directive& directive, const Affine3& camera_from_world,
                   const std::optional<Camera>& before, Warnings& warnings);

/// How long a Camera directive's shutter is open.
float exposure_time(const Directive& directive);

struct Film {
  int width = 0, height = 0;
  bool has_sensor = false;  ///< As version 4 has it: light counts for more the longer the shutter is open,
  float speed = 1;          ///< and by this.
};

/// What a Film directive asks for.
Film make_film(const Directive& directive);

}  // namespace boxwood::io::pbrt
