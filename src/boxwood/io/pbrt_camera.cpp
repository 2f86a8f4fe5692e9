#include "boxwood/io/pbrt_camera.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace boxwood::io::pbrt {
namespace {

constexpr float kDegree = 3.14159265358979f / 180;

/// How much larger than usual the part of the screen is that the picture shows, across the shorter side.
float screen_window(const Directive& directive, Warnings& warnings) {
  const Parameter* parameter = directive.parameters.find("screenwindow");
  if (parameter == nullptr) return 1;
  const std::vector<double>& n = parameter->numbers;  // left, right, bottom, top
  if (n.size() != 4 || !(n[0] < n[1] && n[2] < n[3]))
    fail(parameter->place, "\"screenwindow\" is not four numbers: left < right, bottom < top");
  const double width = n[1] - n[0], height = n[3] - n[2];
  if (std::fabs(n[0] + n[1]) > 1e-4 * width || std::fabs(n[2] + n[3]) > 1e-4 * height)
    warnings.once(
        parameter->place,
        "a screen window beside the middle is not supported; one of its size in the middle stands in");
  return static_cast<float>(std::min(width, height) / 2);
}

}  // namespace

Camera make_camera(const Directive& directive, const Affine3& camera_from_world,
                   const std::optional<Camera>& before, Warnings& warnings) {
  const ParameterList& parameters = directive.parameters;
  const std::string& kind = directive.strings[0];
  Camera camera;
  if (kind == "perspective" || kind == "orthographic") {
    const float window = screen_window(directive, warnings);
    camera.fov_deg = parameters.number("fov", 2 * parameters.number("halffov", 45));
    if (!(camera.fov_deg > 0 && camera.fov_deg < 180))
      fail(directive.place, "\"fov\" is " + std::to_string(camera.fov_deg) +
                                ", expected more than 0 and less than 180 degrees");
    if (kind == "orthographic") camera.orthographic_size = 2 * window;
    if (window != 1)
      camera.fov_deg = 2 / kDegree * std::atan(window * std::tan(0.5f * camera.fov_deg * kDegree));
  } else {
    if (before) camera.fov_deg = before->fov_deg;
    for (const Parameter& parameter : parameters.all()) parameter.is_used = true;
    warnings.once(directive.place, "cameras of the kind " + in_quotes(kind) +
                                       " are not supported; one with an angle of " +
                                       std::to_string(std::lround(camera.fov_deg)) + " degrees stands in");
  }
  camera.lens_radius = parameters.number("lensradius", 0);
  camera.focus_distance = parameters.number("focaldistance", 1e6f);
  if (camera.lens_radius < 0 || !(camera.focus_distance > 0))
    fail(directive.place, "the lens has a radius of " + std::to_string(camera.lens_radius) +
                              " and is focused at " + std::to_string(camera.focus_distance) +
                              ", expected a radius of at least 0 and a distance above 0");
  if (camera.orthographic_size > 0 && camera.lens_radius > 0)
    warnings.once(directive.place, "an orthographic camera with a lens is not supported; all is sharp");
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
  camera.orthographic_size *= scale;
  return camera;
}

float exposure_time(const Directive& directive) {
  const ParameterList& parameters = directive.parameters;
  return parameters.number("shutterclose", 1) - parameters.number("shutteropen", 0);
}

Film make_film(const Directive& directive) {
  // What else a film says (file, crop, white balance) is the renderer's to decide.
  const ParameterList& parameters = directive.parameters;
  Film film{parameters.integer("xresolution", 1280), parameters.integer("yresolution", 720)};
  if (film.width <= 0 || film.height <= 0)
    fail(directive.place, "the film is " + std::to_string(film.width) + " by " + std::to_string(film.height) +
                              " pixels, expected at least 1 by 1");
  film.has_sensor = directive.strings[0] != "image";
  film.speed = parameters.number("iso", 100) / 100;
  if (!(film.speed > 0))
    fail(directive.place, "\"iso\" is " + std::to_string(film.speed * 100) + ", expected more than 0");
  return film;
}

}  // namespace boxwood::io::pbrt
