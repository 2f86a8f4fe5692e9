// description.h: what is in a scene?
//
// Plain data that loaders, the gallery and users fill in, and that Scene (scene.h) builds its trees from. A
// geometry is defined once and appears wherever an Instance places it; a description with no instances at all
// shows each geometry once, where it was defined. Everything is named by its Id: its position in the vector
// here.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "boxwood/core/affine.h"
#include "boxwood/core/id.h"
#include "boxwood/shape/cuboid.h"
#include "boxwood/shape/disk.h"
#include "boxwood/shape/quad.h"
#include "boxwood/shape/shape.h"
#include "boxwood/shape/sphere.h"

namespace boxwood {

/// Triangles that share vertices. `primitive_id` is the position in `indices`.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> indices;
  std::vector<Vec3> normals;  ///< Shading normals: empty, or one for each vertex.
  std::vector<Vec2> uvs;      ///< Texture coordinates: empty, or one for each vertex; v points up.
};

/// Shapes of one kind. `primitive_id` is the position in the vector. AnyShape holds users' own kinds.
using Shapes = std::variant<TriangleMesh, std::vector<Sphere>, std::vector<Quad>, std::vector<Cuboid>,
                            std::vector<Disk>, std::vector<AnyShape>>;

struct Geometry {
  Shapes shapes;
  MaterialId material;                ///< None: the default material (grey, matte).
  std::vector<MaterialId> materials;  ///< Empty, or one for each primitive; wins over `material`.
  std::string name;                   ///< From the file; may be empty.
};

/// One placement of a geometry.
struct Instance {
  GeometryId geometry;
  Affine3 world_from_object;
  MaterialId material;  ///< Wins over the geometry's own when given.
};

/// A texture's pixels, as the codes that the file holds.
struct Texture {
  std::string name;  ///< Where it came from, for messages.
  int width = 0, height = 0;
  /// Rows from top to bottom, RGBA, encoded as `is_srgb` says.
  std::vector<std::array<std::uint8_t, 4>> texels;
  bool is_srgb = true;
};

/// How a surface treats light. The base color is multiplied by the texture where there is one.
struct Material {
  enum class Kind { matte, metal, mirror, glass, plastic };
  std::string name;
  Kind kind = Kind::matte;
  Vec3 color{0.8f, 0.8f, 0.8f};  ///< Reflectance; for glass the tint of what passes through.
  TextureId color_texture;
  float roughness = 0;     ///< Metal and plastic: GGX alpha, 0 to 1; 0 is a perfect mirror.
  float ior = 1.5f;        ///< Glass and plastic: index of refraction.
  Vec3 emission{0, 0, 0};  ///< Radiance that the front side sends out.
  bool emits_from_both_sides = false;
};

/// Where the picture is taken from. Looks along -z of its own frame, +y up, +x right.
struct Camera {
  Affine3 world_from_camera;
  float fov_deg = 45;         ///< Full angle across the shorter side of the picture.
  float lens_radius = 0;      ///< 0: pinhole.
  float focus_distance = 1;   ///< Along -z, in world units; used when lens_radius > 0.
  int width = 0, height = 0;  ///< The picture's size that the file asks for; 0: no wish.
};

/// Light from far away. `zenith` above, `horizon` at eye level, `ground` below, blended smoothly; plus a sun.
struct Sky {
  Vec3 zenith, horizon, ground;  ///< Radiance.
  Vec3 up{0, 1, 0};              ///< Unit length.
  Vec3 sun_direction{0, 1, 0};   ///< Towards the sun; unit length.
  Vec3 sun_radiance{0, 0, 0};    ///< Zero: no sun.
  float sun_angle_deg = 0.53f;   ///< Diameter as seen from the ground.
};

/// A light without a surface.
struct PointLight {
  Vec3 position;
  Vec3 intensity;  ///< Radiant intensity: power per solid angle.
};
struct DistantLight {
  Vec3 direction;   ///< Along which the light travels; unit length.
  Vec3 irradiance;  ///< On a surface that faces it.
};

struct SceneDesc {
  std::vector<Geometry> geometries;  ///< GeometryId
  std::vector<Instance> instances;   ///< InstanceId
  std::vector<Material> materials;   ///< MaterialId
  std::vector<Texture> textures;     ///< TextureId
  std::vector<PointLight> point_lights;
  std::vector<DistantLight> distant_lights;
  std::optional<Camera> camera;  ///< None: the renderer frames the bounds.
  std::optional<Sky> sky;        ///< None: black, or the renderer's plain sky when there is no light at all.
  std::string name;
  std::vector<std::string> warnings;  ///< What a loader could not use and went on without; one line each.

  GeometryId add(Geometry geometry);
  GeometryId add(TriangleMesh mesh, MaterialId material = {});
  template <class S>
  GeometryId add(std::vector<S> shapes, MaterialId material = {}) {
    return add(Geometry{std::move(shapes), material, {}, {}});
  }
  InstanceId add(const Instance& instance);
  MaterialId add(Material material);
  TextureId add(Texture texture);
};

/// How many primitives a geometry has,
/// or a description defines (each geometry once), or shows (each instance).
std::size_t primitive_count(const Geometry& geometry);
std::size_t defined_primitive_count(const SceneDesc& desc);
std::size_t shown_primitive_count(const SceneDesc& desc);

/// What is placed: desc.instances, or one identity instance for each geometry when there are none.
std::vector<Instance> placed_instances(const SceneDesc& desc);

/// Throws std::invalid_argument that names the first thing that is wrong: a vertex that is not finite or
/// above 2^126, an index out of range, an array of the wrong length, an id of nothing, a transform that
/// cannot be inverted.
void check(const SceneDesc& desc);

}  // namespace boxwood
