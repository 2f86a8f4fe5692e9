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
  MaterialId material;  ///< None: the default material.

  /// A ray from here along `direction` that cannot hit the primitive it leaves, at any scale: the origin is
  /// moved along the normal, to the side of `direction`, past the error bound and the leaf test's own
  /// rounding.
  Ray spawn(Vec3 direction, float t_max = kInfinity) const;
  /// How far along the normal that is.
  float clearance() const;
};

/// Brings what surface_at() will read for `hit` nearer to the processor, in two steps with some other work
/// after each: first where the triangle's corners are named, then the corners. Pays where many hits, all over
/// a large scene, are looked at one after the other. Does nothing for a miss.
void prefetch_triangle(const Scene& scene, const Hit& hit);
void prefetch_corners(const Scene& scene, const Hit& hit);

/// Works out the place of `hit`, which `scene` returned for `ray`. Precondition: hit.is_hit().
Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit);

}  // namespace boxwood
