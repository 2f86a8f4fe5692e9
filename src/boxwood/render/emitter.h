// emitter.h: how is a point chosen on shapes that shine?
//
// All shining shapes of one instance form a group. A shape is chosen by power (area times brightness), then a
// point of it uniformly by area; spheres only on the half that faces the receiver. Flat shapes become
// triangles and disks in world space; a sphere keeps its transform, because it may be squeezed, and the
// change of area goes into the density.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "boxwood/scene/surface.h"

namespace boxwood::render {

/// A point of a light and its density.
struct EmitterPoint {
  Surface surface;  ///< position, error, normal.
  Vec3 radiance;    ///< From the front side.
  bool emits_from_both_sides;
  float pdf_area;  ///< Per area, with the choice of the shape in the group.
};

class EmitterGroup {
 public:
  /// The shining shapes of `instance`; empty when it has none. Shapes of users' own kinds cannot be sampled,
  /// and are left out.
  EmitterGroup(const SceneDesc& desc, const Instance& instance);

  bool is_empty() const { return !(strength_ > 0); }
  /// The sum of area times brightness.
  float strength() const { return static_cast<float>(strength_); }
  Box3 bounds() const { return bounds_; }

  /// A point of the group, seen from `receiver`.
  EmitterPoint sample(Vec3 receiver, float choice, Vec2 u) const;

  /// The density with which sample() finds `position`,
  /// which is on the `part` of the primitive. 0 when it never does.
  float pdf_area(PrimId primitive_id, std::uint32_t part, Vec3 position, Vec3 receiver) const;

 private:
  struct Emitter {
    enum class Kind : std::uint8_t { triangle, disk, sphere } kind;
    bool emits_from_both_sides;
    Vec3 a, x, y;  // triangle: corner and edges; disk: middle and two radii; sphere: middle (object space)
    float radius = 0;  // sphere, object space
    Vec3 normal;       // triangle and disk; the front
    Vec3 radiance;
    float area = 0;         // world space; of a squeezed sphere only roughly
    float probability = 0;  // of being chosen in the group
  };

  /// Each adds the emitters of one shape, in object space.
  void add(const Triangle& triangle, const Material& material);
  void add(const Quad& quad, const Material& material);
  void add(const Cuboid& cuboid, const Material& material);
  void add(const Disk& disk, const Material& material);
  void add(const Sphere& sphere, const Material& material);
  void finish(Emitter emitter, const Material& material);

  float area_scale(Vec3 object_normal) const;
  EmitterPoint sample_sphere(const Emitter& sphere, Vec3 receiver, Vec2 u) const;
  float sphere_density(const Emitter& sphere, Vec3 object_normal, Vec3 receiver) const;

  Affine3 world_from_object_, object_from_world_;
  float volume_scale_ = 1;
  std::vector<Emitter> emitters_;
  std::vector<double> running_strength_;      // the sum up to and with each emitter
  std::vector<std::uint32_t> first_emitter_;  // PrimId -> emitters_; kNoEmitter: does not shine
  std::uint32_t emitters_per_part_ = 0;       // a quad has a triangle for each Crossing::part, a cuboid two
  double strength_ = 0;
  Box3 bounds_;
};

}  // namespace boxwood::render
