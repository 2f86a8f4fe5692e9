// makers.h: which functions make the scenes? The gallery's own list; users go through gallery.h.
//
// Every maker returns the same bits each time and on each machine: numbers come from PCG and go through + - *
// / and square roots only, which IEEE defines to the last bit, where sin, pow and the like differ between C
// libraries.
#pragma once

#include "boxwood/core/random.h"
#include "boxwood/scene/description.h"

namespace boxwood::gallery {

SceneDesc make_stilllife();
SceneDesc make_cornell();
SceneDesc make_spheres(std::uint64_t count);     ///< Exactly `count` primitives.
SceneDesc make_soup(std::uint64_t count);        ///< Exactly `count` primitives.
SceneDesc make_duplicates(std::uint64_t count);  ///< Exactly `count` primitives.
SceneDesc make_terrain(std::uint64_t cells);     ///< 2 * cells * cells triangles.
SceneDesc make_city(std::uint64_t towers);       ///< `towers` cuboids and a quad, the ground.

/// Pinhole camera for a picture of the given size.
Camera look_at_camera(Vec3 eye, Vec3 target, float fov_deg, int width, int height);

/// The same bits on every machine, which std::cbrt does not promise. Precondition: x >= 1.
double cube_root(double x);

/// Uniform in the unit ball, by trying until a point of the cube falls inside.
Vec3 in_unit_ball(Random& random);

/// What most materials here are made of.
struct Paint {
  const char* name;
  Vec3 color;
  Material::Kind kind = Material::Kind::matte;
  float roughness = 0;
};
MaterialId add_paint(SceneDesc& desc, const Paint& paint);

/// Adds matte and glossy materials in eight colors that go well together; returns their ids.
std::vector<MaterialId> add_palette(SceneDesc& desc);

/// A clear day: blue above, bright at the horizon, and the sun where it is said to be (any length).
Sky clear_sky(Vec3 towards_sun);

}  // namespace boxwood::gallery
