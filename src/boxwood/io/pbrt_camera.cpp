#include "boxwood/io/pbrt_camera.h"

#include <stdexcept>

namespace boxwood::io::pbrt {

std::optional<Camera> make_camera(const Directive& directive, const Affine3& camera_from_world,
                                  Warnings& warnings) {
  const ParameterList& parameters = directive.parameters;
  if (directive.strings[0] != "perspective") {
    warnings.once(directive.place, "cameras of the kind " + in_quotes(directive.strings[0]) +
                                       " are not supported; the picture is framed on the scene");
    return std::nullopt;
  }
  Camera camera;
  camera.fov_deg = parameters.number("fov", 90);
  if (!(camera.fov_deg > 0 && camera.fov_deg < 180))
    fail(directive.place,
         "\"fov\" is " + std::to_string(camera.fov_deg) + ", expected more than 0 and less than 180 degrees");
  camera.lens_radius = parameters.number("lensradius", 0);
  camera.focus_distance = parameters.number("focaldistance", 1e6f);
  if (camera.lens_radius < 0 || !(camera.focus_distance > 0))
    fail(directive.place, "the lens has a radius of " + std::to_string(camera.lens_radius) +
                              " and is focused at " + std::to_string(camera.focus_distance) +
                              ", expected a radius of at least 0 and a distance above 0");
  parameters.ignore({"shutteropen", "shutterclose"});
  parameters.warn_unused(directive.subject(), warnings);

  Affine3 frame;
  try {
    frame = inverse(camera_from_world);
  } catch (const std::invalid_argument&) {
    fail(directive.place, "the camera stands under a transform that flattens space or is not finite");
  }

  // Take the scale out of the frame and into the lens, so that lengths are the world's.
  const float scale = length(frame.z);
  camera.world_from_camera = {frame.x / scale, frame.y / scale, -frame.z / scale, frame.origin};
  camera.focus_distance *= scale;
  camera.lens_radius *= scale;
  return camera;
}

PictureSize picture_size(const Directive& directive) {
  // What else a film says (file, sensor, crop) is the renderer's to decide.
  const PictureSize size{directive.parameters.integer("xresolution", 1280),
                         directive.parameters.integer("yresolution", 720)};
  if (size.width <= 0 || size.height <= 0)
    fail(directive.place, "the film is " + std::to_string(size.width) + " by " + std::to_string(size.height) +
                              " pixels, expected at least 1 by 1");
  return size;
}

}  // namespace boxwood::io::pbrt
