// pbrt_light.h: which lights does a scene have?
#pragma once

#include "boxwood/io/pbrt_parser.h"

namespace boxwood::io::pbrt {

/// What an AreaLightSource adds to the shapes that follow.
struct Glow {
  Vec3 radiance{0, 0, 0};
  bool is_two_sided = false;
};

/// The glow of an AreaLightSource directive; none, with a warning, for kinds that are not supported.
std::optional<Glow> make_glow(const Directive& directive, const Parser& parser, Warnings& warnings);

/// Makes all lights of a scene so many times as bright.
void brighten(SceneDesc& desc, float by);

/// Adds the light of a LightSource directive to the scene, or a warning.
void add_light(const Directive& directive, const Affine3& world_from_light, const Parser& parser,
               Warnings& warnings, SceneDesc& desc);

}  // namespace boxwood::io::pbrt
