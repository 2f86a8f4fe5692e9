// surface.cpp: how far from the truth may a position be?
//
// A position made of rounded operations comes with a bound of what rounding did (triangle_point.h), and the
// next ray starts beyond it. To that we add what a transform rounds away on the way to object space and back.
#include "boxwood/scene/surface.h"

#include "boxwood/scene/parts.h"
#include "boxwood/scene/triangle_point.h"

namespace boxwood {
namespace {

constexpr float u = kHalfUlp;

/// What the geometry says in its own space.
struct LocalSurface {
  Vec3 position;
  Vec3 error;
  Vec3 shading_normal;  // zero: the geometric one
  Vec2 uv, second_uv;
};

inline LocalSurface on_triangle(const Triangle& t, float v_weight, float w_weight) {
  const BoundedPoint point = point_of_triangle(t, v_weight, w_weight);
  return {point.position, point.error, {0, 0, 0}, {v_weight, w_weight}, {v_weight, w_weight}};
}

LocalSurface on_mesh(const TriangleMesh& mesh, const Hit& hit) {
  LocalSurface s = on_triangle(triangle_of(mesh, hit.primitive_id), hit.u, hit.v);
  const auto& [i, j, k] = mesh.indices[hit.primitive_id.value];
  if (!mesh.uvs.empty()) s.uv = blend(mesh.uvs[i], mesh.uvs[j], mesh.uvs[k], hit.u, hit.v);
  s.second_uv = mesh.second_uvs.empty()
                    ? s.uv
                    : blend(mesh.second_uvs[i], mesh.second_uvs[j], mesh.second_uvs[k], hit.u, hit.v);
  if (!mesh.normals.empty()) {
    const Vec3 n = blend(mesh.normals[i], mesh.normals[j], mesh.normals[k], hit.u, hit.v);
    if (length_squared(n) > 0 && is_finite(n)) s.shading_normal = normalize(n);
  }
  return s;
}

LocalSurface on_shape(const Quad& quad, const PreparedRay&, const Crossing& c) {
  // Back from the quad's (u, v) to the weights of the half that was hit (see shape/quad.h).
  LocalSurface s =
      c.part == 0 ? on_triangle(quad.half(0), c.u - c.v, c.v) : on_triangle(quad.half(1), c.u, c.v - c.u);
  s.uv = {c.u, c.v};
  return s;
}

LocalSurface on_shape(const Sphere& sphere, const PreparedRay& ray, const Crossing& c) {
  LocalSurface s;
  const Vec3 normal = sphere.normal(ray, c);
  s.position = sphere.center + normal * sphere.radius;  // drawn onto the sphere, whatever the error of t
  s.error = abs(sphere.center) * (4 * u) + splat(sphere.radius * 8 * u);
  s.uv = {0.5f + std::atan2(normal.z, normal.x) * 0.15915494f,
          0.5f + std::asin(min(max(normal.y, -1.0f), 1.0f)) * 0.31830989f};
  return s;
}

LocalSurface on_shape(const Cuboid& cuboid, const PreparedRay& ray, const Crossing& c) {
  LocalSurface s;
  const int axis = static_cast<int>(c.part / 2);
  s.position = min(max(ray.origin + ray.direction * c.t, cuboid.lower), cuboid.upper);
  s.position[axis] = c.part % 2 ? cuboid.upper[axis] : cuboid.lower[axis];
  s.error = abs(s.position) * (4 * u);
  const int across = (axis + 1) % 3, along = (axis + 2) % 3;
  const Vec3 size = cuboid.upper - cuboid.lower, from = s.position - cuboid.lower;
  s.uv = {size[across] > 0 ? from[across] / size[across] : 0,
          size[along] > 0 ? from[along] / size[along] : 0};
  return s;
}

LocalSurface on_shape(const Disk& disk, const PreparedRay& ray, const Crossing& c) {
  LocalSurface s;
  const Vec3 normal = disk.normal(ray, c);
  const Vec3 p = ray.origin + ray.direction * c.t;
  s.position = p - normal * dot(normal, p - disk.center);  // drawn onto the plane
  s.error = (abs(s.position) + abs(disk.center) + splat(disk.radius)) * (8 * u);
  Vec3 x, y;
  orthonormal_basis(normal, x, y);
  const Vec3 from = (s.position - disk.center) / disk.radius;
  s.uv = {0.5f + 0.5f * dot(from, x), 0.5f + 0.5f * dot(from, y)};
  return s;
}

LocalSurface on_shape(const AnyShape&, const PreparedRay& ray, const Crossing& c) {
  LocalSurface s;
  s.position = ray.origin + ray.direction * c.t;
  // Nothing is known of how it was worked out.
  s.error = (abs(ray.origin) + abs(ray.direction * c.t)) * (32 * u);
  s.uv = {c.u, c.v};
  return s;
}

/// |m| * v: what a transform makes of an error bound.
Vec3 spread(const Affine3& m, Vec3 v) {
  return abs(m.x) * v.x + abs(m.y) * v.y + abs(m.z) * v.z;
}

}  // namespace

Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit) {
  const Scene::Parts& parts = scene.parts();
  const Geometry& geometry = parts.desc.geometries[hit.geometry_id.value];
  const Instance& instance = parts.instances[hit.instance_id.value];
  const Affine3& world_from_object = instance.world_from_object;
  const Affine3& object_from_world = parts.object_from_world[hit.instance_id.value];
  const bool is_moved = parts.is_moved[hit.instance_id.value] != 0;

  // Ask the geometry, in its own space.
  const auto local = [&]() -> LocalSurface {
    if (const auto* mesh = std::get_if<TriangleMesh>(&geometry.shapes)) return on_mesh(*mesh, hit);
    const PreparedRay prepared =
        is_moved ? PreparedRay(object_from_world.point(ray.origin), object_from_world.vector(ray.direction),
                               -kInfinity, kInfinity, {})
                 : PreparedRay(ray, {});
    const Crossing crossing{hit.t, hit.u, hit.v, hit.part};
    LocalSurface on = with_shape(geometry, hit.primitive_id,
                                 [&](const auto& shape) { return on_shape(shape, prepared, crossing); });
    on.second_uv = on.uv;
    return on;
  }();

  Surface s;
  s.position = local.position;
  s.error = local.error;
  s.normal = hit.normal;
  const bool is_smooth = length_squared(local.shading_normal) > 0;
  s.shading_normal = is_smooth ? local.shading_normal : s.normal;
  s.uv = local.uv;
  s.second_uv = local.second_uv;
  s.material = instance.material.is_valid() ? instance.material
               : geometry.materials.empty() ? geometry.material
                                            : geometry.materials[hit.primitive_id.value];

  // Take it to the world, with what the transform rounds away there and when the next ray comes back.
  if (is_moved) {
    const Vec3 back = spread(object_from_world, abs(world_from_object.point(local.position))) +
                      abs(object_from_world.origin);
    const Vec3 object_error = local.error + back * (8 * u);
    s.position = world_from_object.point(local.position);
    s.error = spread(world_from_object, object_error) +
              (spread(world_from_object, abs(local.position)) + abs(world_from_object.origin)) * (8 * u);
    if (is_smooth) s.shading_normal = normalize(transform_normal(object_from_world, local.shading_normal));
  }

  if (!is_smooth) return s;

  // Keep the shading normal on the geometric side.
  if (dot(s.shading_normal, s.normal) < 0) s.shading_normal = -s.shading_normal;
  if (!is_finite(s.shading_normal)) s.shading_normal = s.normal;
  return s;
}

float Surface::clearance() const {
  return clearance_of(position, error, normal);
}

Ray Surface::spawn(Vec3 direction, float t_max) const {
  const Vec3 side = dot(normal, direction) < 0 ? -normal : normal;
  return {position + side * clearance(), 0, direction, t_max};
}

std::array<float, 4> vertex_color(const Scene& scene, const Hit& hit) {
  const Scene::Parts& parts = scene.parts();
  const auto* mesh = std::get_if<TriangleMesh>(&parts.desc.geometries[hit.geometry_id.value].shapes);
  if (mesh == nullptr || mesh->colors.empty()) return {1, 1, 1, 1};
  const auto& [i, j, k] = mesh->indices[hit.primitive_id.value];
  return blend(mesh->colors[i], mesh->colors[j], mesh->colors[k], hit.u, hit.v);
}

float uv_density(const Scene& scene, const Hit& hit, bool of_second) {
  const Scene::Parts& parts = scene.parts();
  const auto* mesh = std::get_if<TriangleMesh>(&parts.desc.geometries[hit.geometry_id.value].shapes);
  if (mesh == nullptr) return 0;
  const std::vector<Vec2>& uvs = mesh->uvs_for(of_second);
  if (uvs.empty()) return 0;
  const auto& [i, j, k] = mesh->indices[hit.primitive_id.value];
  const Affine3& world_from_object = parts.instances[hit.instance_id.value].world_from_object;
  const Vec2 a = uvs[i], b = uvs[j], c = uvs[k];
  return uv_density_of(world_from_object.vector(mesh->positions[j] - mesh->positions[i]),
                       world_from_object.vector(mesh->positions[k] - mesh->positions[i]),
                       {b.x - a.x, b.y - a.y}, {c.x - a.x, c.y - a.y});
}

}  // namespace boxwood
