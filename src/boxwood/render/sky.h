// sky.h: which light comes from far away?
#pragma once

#include <optional>

#include "boxwood/scene/description.h"

namespace boxwood::render {

/// The radiance of the sky's dome along the unit vector `direction`, without its sun: from `horizon` to
/// `zenith` upwards and to `ground` downwards, as smooth as a smoothstep.
Vec3 sky_radiance(const Sky& sky, Vec3 direction);

/// The sun as a cone of directions.
struct Sun {
  Vec3 direction;  ///< Towards its middle; unit length.
  Vec3 radiance;
  float versine;  ///< 1 - cos of the angle from its middle to its rim.

  float solid_angle() const;
  bool contains(Vec3 unit_direction) const;
};

/// The sky's sun, if it has one that shines.
std::optional<Sun> sun_of(const Sky& sky);

/// What a scene without any light is shown under:
/// an overcast sky and a soft sun behind the viewer's left shoulder.
Sky plain_sky(const Camera& camera);

}  // namespace boxwood::render
