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
#include "boxwood/core/parallel.h"
#include "boxwood/scene/image.h"
#include "boxwood/shape/cuboid.h"
#include "boxwood/shape/disk.h"
#include "boxwood/shape/quad.h"
#include "boxwood/shape/shape.h"
#include "boxwood/shape/sphere.h"

namespace boxwood {

/// A picture whose pixels are read when they are needed. Any number of threads may ask.
class PictureSource {
 public:
  virtual ~PictureSource() = default;
  virtual int width() const = 0;
  virtual int height() const = 0;
  /// The number of levels: each half as wide and high as the one before, the first is the whole picture.
  virtual int levels() const = 0;
  /// The pixel of a level as RGBA codes in [0, 1]; the top row is 0. Precondition: it is inside.
  virtual std::array<float, 4> texel(int level, int x, int y) const = 0;
  /// Four at once, which may be faster: (x0, y0), (x1, y0), (x0, y1), (x1, y1).
  virtual std::array<std::array<float, 4>, 4> texels(int level, int x0, int x1, int y0, int y1) const {
    return {texel(level, x0, y0), texel(level, x1, y0), texel(level, x0, y1), texel(level, x1, y1)};
  }
};

/// Triangles that share vertices. `primitive_id` is the position in `indices`.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> indices;
  std::vector<Vec3> normals;          ///< Shading normals: empty, or one for each vertex.
  std::vector<Vec2> uvs;              ///< Texture coordinates: empty, or one for each vertex; v points up.
  std::vector<Vec2> second_uvs = {};  ///< Likewise, for textures that ask for them.
  std::vector<std::array<float, 4>> colors =
      {};  ///< Linear light and alpha, for textures of that kind: likewise.

  /// Where a texture lies that asks for the first or the second set; the first where there is no second.
  const std::vector<Vec2>& uvs_for(bool by_second) const {
    return by_second && !second_uvs.empty() ? second_uvs : uvs;
  }
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

/// What lies at a point of a surface: a picture's pixels, the colors of a mesh's vertices, or a pattern made
/// of other textures. A color is followed by its alpha, which is 1 where nothing says else.
struct Texture {
  enum class Kind {
    picture,       ///< `texels`, or `source` where there is one.
    product,       ///< first * second.
    mix,           ///< first * (1 - amount) + second * amount.
    checkerboard,  ///< first and second in turns, a unit of u and v each.
    vertex_color,  ///< The mesh's own; white where it has none, and on lamps.
  };
  enum class Wrap { repeat, mirror, clamp, black };

  /// A color times a texture.
  struct Operand {
    Vec3 color{1, 1, 1};
    TextureId texture;  ///< None: the color alone. One that stands earlier in the description.
  };

  std::string name;  ///< Where it came from, for messages.
  int width = 0, height = 0;
  /// Rows from top to bottom, RGBA, encoded as `is_srgb` says.
  std::vector<std::array<std::uint8_t, 4>> texels;
  bool is_srgb = true;

  Kind kind = Kind::picture;
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;  ///< Beyond [0, 1].
  bool is_inverted = false;                           ///< 1 - color.
  bool is_mixed = true;  ///< Between the pixels of a picture; else each is a square of one color.
  Operand first, second, amount;
  /// Texture coordinates from the surface's: (u, v) -> u_axis * u + v_axis * v + offset. For pictures and
  /// checkerboards; operands start from the surface's again.
  Vec2 u_axis{1, 0}, v_axis{0, 1}, offset{0, 0};
  bool is_by_second_uvs = false;  ///< Pictures and checkerboards: which of the surface's they are.
  std::shared_ptr<const PictureSource> source;  ///< A picture whose pixels stay in its file.
};

/// A number at a point of a surface: one channel of a texture.
struct NumberTexture {
  enum class Channel { red, green, blue, alpha, mean };
  TextureId texture;  ///< None: 1 everywhere.
  Channel channel = Channel::mean;
};

/// How a surface treats light. Colors and numbers are multiplied by their textures where there are any.
struct Material {
  enum class Kind {
    matte,        ///< Lambert's law.
    metal,        ///< Rough or smooth, opaque at once.
    mirror,       ///< Reflects `color` at every angle.
    glass,        ///< Reflects and refracts, rough or smooth.
    plastic,      ///< A clear coat over a matte base.
    translucent,  ///< Matte on both sides: reflects `color`, lets `transmission_color` through.
    layered,      ///< glTF's: metal, plastic and glass in shares, below a coat and a sheen.
    mix,          ///< Two other materials in shares.
    clear,        ///< Not there: light goes straight on. Only `absorption` counts.
  };
  /// What `roughness` is. Alpha is the width of GGX.
  enum class RoughnessScale { alpha, square_root_of_alpha, square_of_alpha, pbrt_3 };

  std::string name;
  Kind kind = Kind::matte;
  Vec3 color{0.8f, 0.8f, 0.8f};  ///< Reflectance; for glass the tint of what passes through.
  TextureId color_texture;
  float roughness = 0;     ///< 0 to 1; 0 is perfectly smooth. GGX alpha, unless `roughness_scale` says else.
  float ior = 1.5f;        ///< Glass, plastic and layered: index of refraction.
  Vec3 emission{0, 0, 0};  ///< Radiance that the front side sends out.
  bool emits_from_both_sides = false;
  TextureId emission_texture;

  NumberTexture roughness_texture;
  RoughnessScale roughness_scale = RoughnessScale::alpha;
  /// Metal: complex index of refraction; where k is 0, `color` is what is reflected head-on instead.
  Vec3 metal_eta{0, 0, 0}, metal_k{0, 0, 0};
  Vec3 reflection_color{1, 1, 1};    ///< Glass: the tint of what is reflected.
  Vec3 transmission_color{0, 0, 0};  ///< Translucent.
  TextureId transmission_color_texture;
  bool is_thin = false;  ///< Glass and layered: a pane; light leaves it in the direction that it came from.
  /// What the inside of a closed surface takes away: radiance falls by exp(-absorption * distance). And what
  /// the outside does, for surfaces inside of others.
  Vec3 absorption{0, 0, 0}, outer_absorption{0, 0, 0};

  float opacity = 1;  ///< The share of light that meets the surface at all; the rest goes straight on.
  NumberTexture opacity_texture;
  float alpha_cutoff = -1;   ///< From 0 on: opacity is 1 where it reaches this, else 0.
  TextureId normal_texture;  ///< Normals, by the tangents of the texture coordinates.
  float normal_scale = 1;
  /// Bumps: normals are bent, the coat's too, as if meshes were so much higher, in units of the world.
  float bump = 0;
  NumberTexture bump_texture;  ///< None: no bumps.

  // Layered.
  float metalness = 0, transmission = 0;
  NumberTexture metalness_texture, transmission_texture;
  float specular = 1;            ///< The share of plastic's reflection.
  Vec3 specular_color{1, 1, 1};  ///< Its tint head-on.
  NumberTexture specular_texture;
  TextureId specular_color_texture;
  float coat = 0, coat_roughness = 0;  ///< Share of the coat, and its GGX alpha's square root.
  NumberTexture coat_texture, coat_roughness_texture;
  TextureId coat_normal_texture;  ///< None: the coat is smooth, whatever `normal_texture` does below it.
  float coat_normal_scale = 1;
  Vec3 sheen_color{0, 0, 0};
  float sheen_roughness = 0;  ///< Its square is the width of the sheen.
  TextureId sheen_color_texture;
  NumberTexture sheen_roughness_texture;

  // Mix.
  MaterialId first, second;  ///< Each stands earlier in the description.
  float mix_amount = 0.5f;   ///< The share of `second`.
  NumberTexture mix_texture;
};

/// Where the picture is taken from. Looks along -z of its own frame, +y up, +x right.
struct Camera {
  Affine3 world_from_camera;
  float fov_deg = 45;         ///< Full angle across the shorter side of the picture.
  float lens_radius = 0;      ///< 0: pinhole.
  float focus_distance = 1;   ///< Along -z, in world units; used when lens_radius > 0.
  int width = 0, height = 0;  ///< The picture's size that the file asks for; 0: no wish.
  /// Above 0: all rays are parallel, and the shorter side of the picture spans so much of the world. Then
  /// there is neither an angle nor a lens.
  float orthographic_size = 0;
};

/// Light from infinitely far away, by direction: a picture of longitudes and latitudes, all around. Its top
/// row is +z of its own frame, its bottom row -z; along a row, from the left, it goes from +x by way of +y,
/// -x and -y back to +x.
struct Environment {
  Affine3 world_from_environment;
  Image radiance;  ///< Three channels.
  Vec3 scale{1, 1, 1};
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
struct SpotLight {
  Vec3 position;
  Vec3 direction;          ///< Along its axis; unit length.
  Vec3 intensity;          ///< Radiant intensity on the axis.
  float inner_cosine = 1;  ///< Full up to this angle from the axis,
  float outer_cosine = 0;  ///< none from this one on, and smooth between.
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
  std::vector<SpotLight> spot_lights;
  std::vector<DistantLight> distant_lights;
  std::vector<Environment> environments;
  std::optional<Camera> camera;  ///< None: the renderer frames the bounds.
  std::optional<Sky> sky;        ///< None: black, or the renderer's plain sky when there is no light at all.
  /// False: what glows is a detail of a model, such as a screen, and no reason to leave out the plain sky.
  bool is_lit_by_glow = true;
  /// How often the file wants light to be scattered, at most. None: it does not say.
  std::optional<int> bounces;
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

/// Calls visit(TextureId&) for every place where a material may have a texture.
template <class AnyMaterial, class Visit>
void for_each_texture(AnyMaterial& m, const Visit& visit) {
  for (auto* id : {&m.color_texture, &m.emission_texture, &m.transmission_color_texture, &m.normal_texture,
                   &m.specular_color_texture, &m.sheen_color_texture, &m.coat_normal_texture})
    visit(*id);
  for (auto* number : {&m.roughness_texture, &m.opacity_texture, &m.bump_texture, &m.metalness_texture,
                       &m.transmission_texture, &m.specular_texture, &m.coat_texture,
                       &m.coat_roughness_texture, &m.sheen_roughness_texture, &m.mix_texture})
    visit(number->texture);
}

/// How many primitives a geometry has,
/// or a description defines (each geometry once), or shows (each instance).
std::size_t primitive_count(const Geometry& geometry);
std::size_t defined_primitive_count(const SceneDesc& desc);
std::size_t shown_primitive_count(const SceneDesc& desc);

/// What is placed: desc.instances, or one identity instance for each geometry when there are none.
std::vector<Instance> placed_instances(const SceneDesc& desc);

/// Throws std::invalid_argument that names the first thing that is wrong: a vertex that is not finite or
/// above 2^126, an index out of range, an array of the wrong length, an id of nothing, a transform that
/// cannot be inverted. The executor shows in the time only.
void check(const SceneDesc& desc, Executor& executor = serial_executor());

}  // namespace boxwood
