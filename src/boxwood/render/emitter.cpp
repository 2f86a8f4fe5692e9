#include "boxwood/render/emitter.h"

#include <algorithm>

#include "boxwood/render/material.h"
#include "boxwood/render/texture.h"
#include "boxwood/render/warp.h"
#include "boxwood/scene/triangle_point.h"

namespace boxwood::render {
namespace {

constexpr std::uint32_t kNoEmitter = 0xffffffffu;

/// How far from a surface a ray towards it has to end, or it might hit the surface. The point was put
/// together from a corner and two edges, or from a middle and a radius, and transformed; `parts` bounds the
/// sum of the sizes of all that was added.
float clearance_of(Vec3 parts, Vec3 normal) {
  Surface point{};
  point.position = parts;
  point.error = parts * 0x1p-19f;
  point.normal = normal;
  return point.clearance();
}

std::uint32_t emitters_per_part(const Shapes& shapes) {
  if (std::holds_alternative<std::vector<Quad>>(shapes)) return 1;
  if (std::holds_alternative<std::vector<Cuboid>>(shapes)) return 1;
  return 0;
}

}  // namespace

EmitterGroup::EmitterGroup(const SceneDesc& desc, const Instance& instance)
    : desc_(desc),
      world_from_object_(instance.world_from_object),
      object_from_world_(inverse(instance.world_from_object)),
      volume_scale_(static_cast<float>(std::fabs(boxwood::determinant(instance.world_from_object)))) {
  const Geometry& geometry = desc.geometries[instance.geometry.value];
  const auto material_at = [&](std::size_t primitive) -> const Material& {
    if (instance.material.is_valid()) return material_of(desc, instance.material);
    return material_of(desc, geometry.materials.empty() ? geometry.material : geometry.materials[primitive]);
  };

  // Most geometry does not shine; find out before anything is stored for it.
  const std::size_t count = primitive_count(geometry);
  const bool is_uniform = instance.material.is_valid() || geometry.materials.empty();
  bool shines = false;
  for (std::size_t i = 0; i < (is_uniform ? std::min<std::size_t>(count, 1) : count) && !shines; ++i)
    shines = is_emissive(material_at(i));
  if (!shines || std::holds_alternative<std::vector<AnyShape>>(geometry.shapes)) return;

  mesh_ = std::get_if<TriangleMesh>(&geometry.shapes);
  emitters_per_part_ = emitters_per_part(geometry.shapes);
  first_emitter_.assign(count, kNoEmitter);
  std::visit(
      [&](const auto& shapes) {
        using Shapes = std::decay_t<decltype(shapes)>;
        for (std::size_t i = 0; i < count; ++i) {
          const Material& material = material_at(i);
          if (!is_emissive(material)) continue;
          first_emitter_[i] = static_cast<std::uint32_t>(emitters_.size());
          if constexpr (std::is_same_v<Shapes, TriangleMesh>) {
            const auto& [a, b, c] = shapes.indices[i];
            add(Triangle{shapes.positions[a], shapes.positions[b], shapes.positions[c]}, material);
            if (material.emission_texture.is_valid()) {
              Emitter& emitter = emitters_.back();
              emitter.texture = material.emission_texture;
              emitter.triangle = static_cast<std::uint32_t>(i);
              emitter.mean_radiance = mean_of_texture(emitter);
            }
          } else if constexpr (!std::is_same_v<Shapes, std::vector<AnyShape>>) {
            add(shapes[i], material);
          }
        }
      },
      geometry.shapes);
}

Vec3 EmitterGroup::textured_radiance(const Emitter& triangle, Vec2 weights) const {
  const auto& [i, j, k] = mesh_->indices[triangle.triangle];
  const auto place = [&, i = i, j = j, k = k](const std::vector<Vec2>& uvs) {
    return uvs.empty() ? weights : blend(uvs[i], uvs[j], uvs[k], weights.x, weights.y);
  };
  const TexturePoint point{place(mesh_->uvs), place(mesh_->uvs_for(true))};
  return triangle.radiance * texture_at(desc_, triangle.texture, point).color;
}

/// The mean over some points; never 0, since there may be light between them.
float EmitterGroup::mean_of_texture(const Emitter& triangle) const {
  constexpr int kSteps = 4;
  float sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j)
      sum += brightness(
          textured_radiance(triangle, uniform_triangle({(static_cast<float>(i) + 0.5f) / kSteps,
                                                        (static_cast<float>(j) + 0.5f) / kSteps})));
  return max(sum / (kSteps * kSteps), 0.01f * brightness(triangle.radiance));
}

LightBounds EmitterGroup::bounds(std::size_t index) const {
  const Emitter& emitter = emitters_[index];
  LightBounds bounds;
  bounds.box = boxes_[index];
  bounds.strength = emitter.area * emitter.mean_radiance;
  bounds.is_two_sided = emitter.emits_from_both_sides;
  if (emitter.kind != Emitter::Kind::sphere) {
    bounds.axis = emitter.normal;
    bounds.cos_facing = 1;
  }
  return bounds;
}

void EmitterGroup::add(const Triangle& triangle, const Material& material) {
  Emitter emitter{Emitter::Kind::triangle};
  emitter.a = world_from_object_.point(triangle.a);
  emitter.x = world_from_object_.point(triangle.b) - emitter.a;
  emitter.y = world_from_object_.point(triangle.c) - emitter.a;
  emitter.area = 0.5f * length(cross(emitter.x, emitter.y));
  emitter.normal = transform_normal(object_from_world_, triangle.normal());
  Box3 box;
  box.extend(emitter.a);
  box.extend(emitter.a + emitter.x);
  box.extend(emitter.a + emitter.y);
  finish(emitter, material, box);
}

void EmitterGroup::add(const Quad& quad, const Material& material) {
  add(quad.half(0), material);
  add(quad.half(1), material);
}

/// A parallelogram for each face, in the order of Cuboid's parts.
void EmitterGroup::add(const Cuboid& cuboid, const Material& material) {
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, across = (axis + 1) % 3, along = (axis + 2) % 3;
    const bool is_upper = face % 2 == 1;
    Vec3 corner = cuboid.lower, x{0, 0, 0}, y{0, 0, 0}, out{0, 0, 0};
    corner[axis] = is_upper ? cuboid.upper[axis] : cuboid.lower[axis];
    x[across] = cuboid.upper[across] - cuboid.lower[across];
    y[along] = cuboid.upper[along] - cuboid.lower[along];
    out[axis] = is_upper ? 1.0f : -1.0f;

    Emitter emitter{Emitter::Kind::parallelogram};
    emitter.a = world_from_object_.point(corner);
    emitter.x = world_from_object_.vector(x);
    emitter.y = world_from_object_.vector(y);
    emitter.area = length(cross(emitter.x, emitter.y));
    emitter.normal = transform_normal(object_from_world_, out);
    Box3 box;
    for (const Vec3 p :
         {emitter.a, emitter.a + emitter.x, emitter.a + emitter.y, emitter.a + emitter.x + emitter.y})
      box.extend(p);
    finish(emitter, material, box);
  }
}

void EmitterGroup::add(const Disk& disk, const Material& material) {
  Emitter emitter{Emitter::Kind::disk};
  const Frame frame(normalize(disk.facing));
  emitter.a = world_from_object_.point(disk.center);
  emitter.x = world_from_object_.vector(frame.x * disk.radius);
  emitter.y = world_from_object_.vector(frame.y * disk.radius);
  emitter.area = kPi * length(cross(emitter.x, emitter.y));
  emitter.normal = transform_normal(object_from_world_, frame.z);
  finish(emitter, material, transform_box(world_from_object_, disk.box()));
}

void EmitterGroup::add(const Sphere& sphere, const Material& material) {
  Emitter emitter{Emitter::Kind::sphere};
  emitter.a = sphere.center;
  emitter.radius = sphere.radius;
  // Squeezed spheres: the area for a mean scale will do, since it only guides the choice.
  emitter.area = 4 * kPi * sphere.radius * sphere.radius * std::cbrt(volume_scale_ * volume_scale_);
  emitter.normal = {0, 0, 1};
  finish(emitter, material, transform_box(world_from_object_, sphere.box()));
}

void EmitterGroup::finish(Emitter emitter, const Material& material, Box3 box) {
  emitter.radiance = material.emission;
  emitter.mean_radiance = brightness(material.emission);
  emitter.emits_from_both_sides = material.emits_from_both_sides;
  emitter.normal = normalize(emitter.normal);
  // Shapes that cannot be hit cannot shine either.
  if (!(emitter.area > 0) || !std::isfinite(emitter.area) || !is_finite(emitter.normal)) emitter.area = 0;
  emitter.clearance = clearance_of(abs(emitter.a) + abs(emitter.x) + abs(emitter.y), emitter.normal);
  emitters_.push_back(emitter);
  boxes_.push_back(box);
}

EmitterPoint EmitterGroup::sample(std::size_t index, Vec3 receiver, Vec2 u) const {
  const Emitter& emitter = emitters_[index];
  if (emitter.kind == Emitter::Kind::sphere) return sample_sphere(emitter, receiver, u);

  const Vec2 weights = emitter.kind == Emitter::Kind::triangle        ? uniform_triangle(u)
                       : emitter.kind == Emitter::Kind::parallelogram ? u
                                                                      : uniform_disk(u);
  EmitterPoint point{};
  point.position = emitter.a + emitter.x * weights.x + emitter.y * weights.y;
  point.normal = emitter.normal;
  point.clearance = emitter.clearance;
  point.radiance = emitter.texture.is_valid() ? textured_radiance(emitter, weights) : emitter.radiance;
  point.emits_from_both_sides = emitter.emits_from_both_sides;
  point.pdf_area = 1 / emitter.area;
  return point;
}

std::optional<FlatLight> EmitterGroup::flat_light(std::size_t index) const {
  const Emitter& emitter = emitters_[index];
  const bool is_triangle = emitter.kind == Emitter::Kind::triangle;
  if ((!is_triangle && emitter.kind != Emitter::Kind::parallelogram) || emitter.texture.is_valid())
    return std::nullopt;
  return FlatLight{emitter.a,
                   emitter.x,
                   emitter.y,
                   emitter.normal,
                   emitter.radiance,
                   1 / emitter.area,
                   emitter.clearance,
                   is_triangle ? 1.0f : 0.0f,
                   emitter.emits_from_both_sides ? 1.0f : 0.0f};
}

/// World area over object area, for a piece of surface with this normal: |det M| |M^-T n|.
float EmitterGroup::area_scale(Vec3 object_normal) const {
  return volume_scale_ * length(transform_normal(object_from_world_, object_normal));
}

float EmitterGroup::sphere_density(const Emitter& sphere, Vec3 object_normal, Vec3 receiver) const {
  const Vec3 to_receiver = object_from_world_.point(receiver) - sphere.a;
  const bool is_outside = length_squared(to_receiver) > sphere.radius * sphere.radius;
  if (is_outside && !(dot(to_receiver, object_normal) > 0)) return 0;
  const float object_area = (is_outside ? 2 : 4) * kPi * sphere.radius * sphere.radius;
  return 1 / (object_area * area_scale(object_normal));
}

EmitterPoint EmitterGroup::sample_sphere(const Emitter& sphere, Vec3 receiver, Vec2 u) const {
  // From outside only the half that faces the receiver can be seen; from inside all of it.
  const Vec3 to_receiver = object_from_world_.point(receiver) - sphere.a;
  const bool is_outside = length_squared(to_receiver) > sphere.radius * sphere.radius;
  const Vec3 normal =
      is_outside ? Frame(normalize(to_receiver)).to_world(uniform_cone(u, 1)) : uniform_cone(u, 2);

  EmitterPoint point{};
  point.position = world_from_object_.point(sphere.a + normal * sphere.radius);
  point.normal = normalize(transform_normal(object_from_world_, normal));
  const Vec3 reach = abs(sphere.a) + splat(sphere.radius);
  point.clearance = clearance_of(abs(world_from_object_.x) * reach.x + abs(world_from_object_.y) * reach.y +
                                     abs(world_from_object_.z) * reach.z + abs(world_from_object_.origin),
                                 point.normal);
  point.radiance = sphere.radiance;
  point.emits_from_both_sides = sphere.emits_from_both_sides;
  point.pdf_area = sphere_density(sphere, normal, receiver);
  return point;
}

std::optional<std::uint32_t> EmitterGroup::find(PrimId primitive_id, std::uint32_t part) const {
  const std::uint32_t first = first_emitter_[primitive_id.value];
  if (first == kNoEmitter) return std::nullopt;
  return first + part * emitters_per_part_;
}

float EmitterGroup::pdf_area(std::size_t index, Vec3 position, Vec3 receiver) const {
  const Emitter& emitter = emitters_[index];
  if (emitter.kind != Emitter::Kind::sphere) return emitter.area > 0 ? 1 / emitter.area : 0;
  return sphere_density(emitter, normalize(object_from_world_.point(position) - emitter.a), receiver);
}

}  // namespace boxwood::render
