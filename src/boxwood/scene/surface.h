// surface.h: what is it like where a ray hit, and where may the next ray start?
#pragma once

#include "boxwood/scene/scene.h"

namespace boxwood {

/// The place of a hit, in world space.
struct Surface {
  Vec3 position;
  Vec3 error;           ///< The surface passes within this of `position`, component by component.
  Vec3 normal;          ///< Geometric; unit length; as in Hit (not turned towards the ray).
  Vec3 shading_normal;  ///< Interpolated where the mesh has normals, on the same side as `normal`; else
                        ///< `normal`.
  Vec2 uv;              ///< Interpolated where the mesh has them; else the hit's u, v.
  Vec2 second_uv;       ///< Of the second set where the mesh has one; else `uv`.
  MaterialId material;  ///< None: the default material.

  /// A ray from here along `direction` that cannot hit the primitive it leaves, at any scale: the origin is
  /// moved along the normal, to the side of `direction`, past the error bound and the leaf test's own
  /// rounding.
  Ray spawn(Vec3 direction, float t_max = kInfinity) const;
  /// How far along the normal that is.
  float clearance() const;
};

/// Works out the place of `hit`, which `scene` returned for `ray`. Precondition: hit.is_hit().
Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit);

/// The color and alpha of the mesh's vertices there; white where it has none.
std::array<float, 4> vertex_color(const Scene& scene, const Hit& hit);

/// How much of uv, on a side, a square of the world of side 1 covers there; 0 where it is not known. Of the
/// first set or the second.
float uv_density(const Scene& scene, const Hit& hit, bool of_second = false);

}  // namespace boxwood
