#include "boxwood/io/pbrt_light.h"

#include <algorithm>
#include <cmath>

#include "boxwood/io/environment_map.h"
#include "boxwood/io/pbrt_spectrum.h"

namespace boxwood::io::pbrt {
namespace {

constexpr float kPi = 3.14159265358979f;

/// Light from everywhere: a picture of the surroundings, or a sky of one color. Several skies add up.
void add_infinite(const Directive& directive, Vec3 radiance, const Affine3& world_from_light,
                  const Parser& parser, Warnings& warnings, SceneDesc& desc) {
  const ParameterList& parameters = directive.parameters;
  const std::string file = parameters.string("mapname", parameters.string("filename", ""));
  if (!file.empty()) {
    try {
      std::size_t mended = 0;
      Environment environment{world_from_light, read_environment(parser.resolve(file), mended), radiance};
      if (mended > 0)
        warnings.once(directive.place, "the environment map " + in_quotes(file) + " has " +
                                           std::to_string(mended) +
                                           " pixels that are negative or not finite; they are black");
      desc.environments.push_back(std::move(environment));
      return;
    } catch (const FileError& error) {
      warnings.once(directive.place, std::string("the environment map cannot be read (") + error.what() +
                                         "); white stands in");
    }
  }
  if (const float wanted = parameters.number("illuminance", -1); wanted > 0) radiance *= wanted / kPi;
  if (!desc.sky) desc.sky.emplace();
  for (Vec3* color : {&desc.sky->zenith, &desc.sky->horizon, &desc.sky->ground}) *color += radiance;
}

void add_spot(const Directive& directive, const Affine3& world_from_light, Vec3 intensity, SceneDesc& desc) {
  const ParameterList& parameters = directive.parameters;
  const Vec3 from = parameters.vector("from", {0, 0, 0}), to = parameters.vector("to", {0, 0, 1});
  const float angle = parameters.number("coneangle", 30), soft = parameters.number("conedeltaangle", 5);
  if (!(angle > 0 && angle <= 180) || !(soft >= 0))
    fail(directive.place, "the spot light has a cone of " + std::to_string(angle) + " degrees, soft over " +
                              std::to_string(soft) + ", expected more than 0 to 180, and at least 0");
  constexpr float kDegree = kPi / 180;
  SpotLight light;
  light.position = world_from_light.point(from);
  light.direction = normalize(world_from_light.vector(to - from));
  if (!is_finite(light.direction))
    fail(directive.place, "the spot light has no direction: \"from\" and \"to\" are the same");
  light.intensity = intensity;
  light.outer_cosine = std::cos(angle * kDegree);
  light.inner_cosine = std::cos(std::max(angle - soft, 0.0f) * kDegree);
  desc.spot_lights.push_back(light);
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

void brighten(SceneDesc& desc, float by) {
  for (PointLight& light : desc.point_lights) light.intensity *= by;
  for (SpotLight& light : desc.spot_lights) light.intensity *= by;
  for (DistantLight& light : desc.distant_lights) light.irradiance *= by;
  for (Environment& environment : desc.environments) environment.scale *= by;
  for (Material& material : desc.materials) material.emission *= by;
  if (desc.sky)
    for (Vec3* color : {&desc.sky->zenith, &desc.sky->horizon, &desc.sky->ground}) *color *= by;
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
  // Version 4 may say how much light there is in all: `unit` is what a strength of 1 makes.
  const auto measured = [&](const char* name, float unit) {
    const float wanted = parameters.number(name, -1);
    return wanted > 0 ? wanted / unit : 1.0f;
  };

  if (kind == "point") {
    desc.point_lights.push_back({world_from_light.point(parameters.vector("from", {0, 0, 0})),
                                 strength("I") * measured("power", 4 * kPi)});
  } else if (kind == "distant") {
    const Vec3 along = parameters.vector("to", {0, 0, 1}) - parameters.vector("from", {0, 0, 0});
    const Vec3 direction = normalize(world_from_light.vector(along));
    if (!is_finite(direction))
      fail(directive.place, "the distant light has no direction: \"from\" and \"to\" are the same");
    desc.distant_lights.push_back({direction, strength("L") * measured("illuminance", 1)});
  } else if (kind == "spot") {
    add_spot(directive, world_from_light, strength("I"), desc);
    SpotLight& light = desc.spot_lights.back();
    // Full up to the inner angle, and half of it on average from there on.
    light.intensity *= measured("power", 2 * kPi * (1 - (light.inner_cosine + light.outer_cosine) / 2));
  } else if (kind == "infinite") {
    add_infinite(directive, strength("L"), world_from_light, parser, warnings, desc);
  } else {
    warnings.once(directive.place,
                  "lights of the kind " + in_quotes(kind) + " are not supported and left out");
    return;
  }
  parameters.warn_unused(directive.subject(), warnings);
}

}  // namespace boxwood::io::pbrt
