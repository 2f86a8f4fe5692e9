#include "boxwood/render/uv_frame.h"

#include "boxwood/render/texture.h"
#include "boxwood/scene/parts.h"

namespace boxwood::render {
namespace {

/// The edges of the triangle that was hit, from its first corner, in the world and in uv.
struct Edges {
  Vec3 first, second;
  Vec2 first_uv, second_uv;
  float uv_area;  // signed, doubled
};

std::optional<Edges> edges_at(const Scene& scene, const Hit& hit, const Texture& texture) {
  const Scene::Parts& parts = scene.parts();
  const auto* mesh = std::get_if<TriangleMesh>(&parts.desc.geometries[hit.geometry_id.value].shapes);
  if (mesh == nullptr) return std::nullopt;
  const std::vector<Vec2>& uvs = mesh->uvs_for(texture.is_by_second_uvs);
  if (uvs.empty()) return std::nullopt;
  const auto& [i, j, k] = mesh->indices[hit.primitive_id.value];
  const Affine3& world_from_object = parts.instances[hit.instance_id.value].world_from_object;
  const Vec2 a = uvs[i], b = uvs[j], c = uvs[k];
  const auto placed = [&](float u, float v) {  // a texture that is turned has its own directions
    return Vec2{texture.u_axis.x * u + texture.v_axis.x * v, texture.u_axis.y * u + texture.v_axis.y * v};
  };
  Edges e{world_from_object.vector(mesh->positions[j] - mesh->positions[i]),
          world_from_object.vector(mesh->positions[k] - mesh->positions[i]), placed(b.x - a.x, b.y - a.y),
          placed(c.x - a.x, c.y - a.y), 0};
  e.uv_area = e.first_uv.x * e.second_uv.y - e.first_uv.y * e.second_uv.x;
  return e;
}

}  // namespace

std::optional<UvFrame> uv_frame(const Scene& scene, const Hit& hit, const Texture& texture) {
  const std::optional<Edges> e = edges_at(scene, hit, texture);
  if (!e || !(std::fabs(e->uv_area) > 0)) return std::nullopt;
  const UvFrame frame{(e->first * e->second_uv.y - e->second * e->first_uv.y) / e->uv_area,
                      (e->second * e->first_uv.x - e->first * e->second_uv.x) / e->uv_area};
  if (!is_finite(frame.along_u) || !is_finite(frame.along_v)) return std::nullopt;
  return frame;
}

Vec3 mapped_normal(const Scene& scene, const Hit& hit, const Surface& surface, TextureId map, float scale) {
  if (!map.is_valid()) return surface.shading_normal;
  const std::optional<UvFrame> frame = uv_frame(scene, hit, scene.description().textures[map.value]);
  if (!frame) return surface.shading_normal;

  // The frame's vectors drawn into the plane of the shading normal, and kept apart by the surface's hand.
  const Vec3 n = surface.shading_normal;
  const Vec3 tangent = normalize(frame->along_u - n * dot(n, frame->along_u));
  const Vec3 side = cross(n, tangent);
  const Vec3 bitangent = dot(side, frame->along_v) < 0 ? -side : side;
  const Vec3 code = texture_at(scene.description(), map, TexturePoint(surface)).color;
  const float x = (2 * code.x - 1) * scale, y = (2 * code.y - 1) * scale;
  const Vec3 mapped = normalize(tangent * x + bitangent * y + n * (2 * code.z - 1));
  return is_finite(mapped) && dot(mapped, surface.normal) > 0 ? mapped : n;
}

Vec3 bumped_normal(const Scene& scene, const Hit& hit, const Surface& surface, Vec3 normal, float height,
                   const NumberTexture& texture) {
  const std::optional<UvFrame> frame = uv_frame(scene, hit, Texture{});
  if (!frame) return normal;

  // How fast the height grows with u and v, between two points a texel or so apart.
  constexpr float kStep = 0x1p-11f;
  const auto height_at = [&](float u, float v) {
    const auto moved = [&](Vec2 uv) { return Vec2{uv.x + u, uv.y + v}; };
    return height *
           number_at(scene.description(), texture, TexturePoint(moved(surface.uv), moved(surface.second_uv)));
  };
  const float along_u = (height_at(kStep, 0) - height_at(-kStep, 0)) / (2 * kStep),
              along_v = (height_at(0, kStep) - height_at(0, -kStep)) / (2 * kStep);

  // The gradient on the surface (Mikkelsen, "Bump Mapping Unparametrized Surfaces on the GPU", 2010, eq. 2).
  const Vec3 n = normal;
  const Vec3 gradient = (cross(frame->along_v, n) * along_u + cross(n, frame->along_u) * along_v) /
                        dot(n, cross(frame->along_u, frame->along_v));
  const Vec3 bumped = normalize(n - gradient);
  return is_finite(bumped) && dot(bumped, surface.normal) > 0 ? bumped : n;
}

}  // namespace boxwood::render
