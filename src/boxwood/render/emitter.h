// emitter.h: how is a point chosen on shapes that shine?
//
// All shining shapes of one instance form a group of emitters; which of them is tried, the light tree says
// (light_tree.h). A point of it is chosen uniformly by area; on spheres only on the half that faces the
// receiver. Flat shapes become triangles, parallelograms and disks in world space; a sphere keeps its
// transform, because it may be squeezed, and the change of area goes into the density.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "boxwood/render/flat_light.h"
#include "boxwood/render/light_tree.h"
#include "boxwood/scene/surface.h"

namespace boxwood::render {

/// How much light matters to the eye.
inline float brightness(Vec3 radiance) {
  return 0.2126f * radiance.x + 0.7152f * radiance.y + 0.0722f * radiance.z;
}

/// A point of a light and its density.
struct EmitterPoint {
  Vec3 position, normal;
  float clearance;  ///< How far along the normal, to one side or the other, a ray to it has to end.
  Vec3 radiance;    ///< From the front side.
  bool emits_from_both_sides;
  float pdf_area;  ///< Per area.
};

class EmitterGroup {
 public:
  /// The shining shapes of `instance`; empty when it has none. Shapes of users' own kinds cannot be sampled,
  /// and are left out. Keeps a reference to `desc`.
  EmitterGroup(const SceneDesc& desc, const Instance& instance);

  std::size_t size() const { return emitters_.size(); }
  /// Where an emitter is and what it sends out at most.
  LightBounds bounds(std::size_t emitter) const;

  /// A point of an emitter, seen from `receiver`.
  EmitterPoint sample(std::size_t emitter, Vec3 receiver, Vec2 u) const;

  /// The emitter, if it is flat and has one color (flat_light.h).
  std::optional<FlatLight> flat_light(std::size_t emitter) const;

  /// The emitter that a `part` of a primitive is; nothing when it is none.
  std::optional<std::uint32_t> find(PrimId primitive_id, std::uint32_t part) const;
  /// The density with which sample() finds `position`, which is on it. 0 when it never does.
  float pdf_area(std::size_t emitter, Vec3 position, Vec3 receiver) const;

 private:
  struct Emitter {
    enum class Kind : std::uint8_t { triangle, parallelogram, disk, sphere } kind;
    bool emits_from_both_sides;
    Vec3 a, x, y;  // triangle and parallelogram: corner and edges; disk: middle and two radii; sphere: middle
                   // (object space)
    float radius = 0;  // sphere, object space
    Vec3 normal;       // triangle and disk; the front
    Vec3 radiance;
    float area = 0;              // world space; of a squeezed sphere only roughly
    float mean_radiance = 0;     // brightness
    float clearance = 0;         // of all but spheres
    TextureId texture;           // of the radiance; triangles of meshes only
    std::uint32_t triangle = 0;  // of the mesh
  };

  /// Each adds the emitters of one shape, in object space.
  void add(const Triangle& triangle, const Material& material);
  void add(const Quad& quad, const Material& material);
  void add(const Cuboid& cuboid, const Material& material);
  void add(const Disk& disk, const Material& material);
  void add(const Sphere& sphere, const Material& material);
  void finish(Emitter emitter, const Material& material, Box3 box);
  float mean_of_texture(const Emitter& triangle) const;
  Vec3 textured_radiance(const Emitter& triangle, Vec2 weights) const;

  float area_scale(Vec3 object_normal) const;
  EmitterPoint sample_sphere(const Emitter& sphere, Vec3 receiver, Vec2 u) const;
  float sphere_density(const Emitter& sphere, Vec3 object_normal, Vec3 receiver) const;

  const SceneDesc& desc_;
  const TriangleMesh* mesh_ = nullptr;  // null: other shapes
  Affine3 world_from_object_, object_from_world_;
  float volume_scale_ = 1;
  std::vector<Emitter> emitters_;
  std::vector<Box3> boxes_;                   // of the emitters, in world space
  std::vector<std::uint32_t> first_emitter_;  // PrimId -> emitters_; kNoEmitter: does not shine
  std::uint32_t emitters_per_part_ = 0;  // a quad has a triangle for each Crossing::part, a cuboid a face
};

}  // namespace boxwood::render
