#include "boxwood/io/pbrt_light.h"

#include <cmath>

#include "boxwood/io/image.h"
#include "boxwood/io/pbrt_spectrum.h"

namespace boxwood::io::pbrt {
namespace {

/// The mean radiance of an environment map. A map that is twice as wide as high holds latitudes (version 3),
/// whose rows shrink towards the poles; a square one (version 4) keeps areas.
Vec3 average_environment(const Image& image) {
  const bool keeps_areas = image.width == image.height;
  double sum[3] = {0, 0, 0}, whole = 0;
  for (int y = 0; y < image.height; ++y) {
    const double weight = keeps_areas ? 1 : std::sin((y + 0.5) / image.height * 3.14159265358979323846);
    for (int x = 0; x < image.width; ++x) {
      const float* pixel = image.at(x, y);
      for (int c = 0; c < 3; ++c) {
        const float value = pixel[image.channels >= 3 ? c : 0];
        if (value > 0 && value < kInfinity) sum[c] += weight * value;
      }
      whole += weight;
    }
  }
  return whole > 0 ? Vec3{float(sum[0] / whole), float(sum[1] / whole), float(sum[2] / whole)}
                   : Vec3{0, 0, 0};
}

/// Light from everywhere: a sky of one color. Several of them add up.
void add_infinite(const Directive& directive, Vec3 radiance, const Parser& parser, Warnings& warnings,
                  SceneDesc& desc) {
  const ParameterList& parameters = directive.parameters;
  const std::string file = parameters.string("mapname", parameters.string("filename", ""));
  if (!file.empty()) {
    std::string message =
        "environment maps are not supported; the mean color of " + in_quotes(file) + " stands in";
    try {
      radiance = radiance * average_environment(read_image(parser.resolve(file)));
    } catch (const FileError& error) {
      message = std::string("the environment map cannot be read (") + error.what() + "); white stands in";
    }
    warnings.once(directive.place, message);
  }
  if (!desc.sky) desc.sky.emplace();
  for (Vec3* color : {&desc.sky->zenith, &desc.sky->horizon, &desc.sky->ground}) *color += radiance;
}

}  // namespace

std::optional<Glow> make_glow(const Directive& directive, const Parser& parser, Warnings& warnings) {
  const ParameterList& parameters = directive.parameters;
  if (directive.strings[0] != "diffuse" && directive.strings[0] != "area") {
    warnings.once(directive.place, "area lights of the kind " + in_quotes(directive.strings[0]) +
                                       " are not supported and left out");
    return std::nullopt;
  }
  Glow glow;
  glow.radiance = color_of(parameters, "L", {1, 1, 1}, parser, warnings) *
                  color_of(parameters, "scale", {1, 1, 1}, parser, warnings);
  glow.radiance = max(glow.radiance, Vec3{0, 0, 0});
  glow.is_two_sided = parameters.boolean("twosided", false);
  parameters.ignore({"samples", "nsamples"});
  parameters.warn_unused(directive.subject(), warnings);
  return glow;
}

void add_light(const Directive& directive, const Affine3& world_from_light, const Parser& parser,
               Warnings& warnings, SceneDesc& desc) {
  const ParameterList& parameters = directive.parameters;
  const std::string& kind = directive.strings[0];
  const Vec3 scale = color_of(parameters, "scale", {1, 1, 1}, parser, warnings);
  const auto strength = [&](const char* name) {
    return max(color_of(parameters, name, {1, 1, 1}, parser, warnings) * scale, Vec3{0, 0, 0});
  };
  parameters.ignore({"samples", "nsamples"});

  if (kind == "point") {
    desc.point_lights.push_back(
        {world_from_light.point(parameters.vector("from", {0, 0, 0})), strength("I")});
  } else if (kind == "distant") {
    const Vec3 along = parameters.vector("to", {0, 0, 1}) - parameters.vector("from", {0, 0, 0});
    const Vec3 direction = normalize(world_from_light.vector(along));
    if (!is_finite(direction))
      fail(directive.place, "the distant light has no direction: \"from\" and \"to\" are the same");
    desc.distant_lights.push_back({direction, strength("L")});
  } else if (kind == "infinite") {
    add_infinite(directive, strength("L"), parser, warnings, desc);
  } else {
    warnings.once(directive.place,
                  "lights of the kind " + in_quotes(kind) + " are not supported and left out");
    return;
  }
  parameters.warn_unused(directive.subject(), warnings);
}

}  // namespace boxwood::io::pbrt
