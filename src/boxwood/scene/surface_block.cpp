#include "boxwood/scene/surface_block.h"

#include "boxwood/core/every_cpu.h"
#include "boxwood/core/prefetch.h"
#include "boxwood/scene/parts.h"
#include "boxwood/scene/triangle_point.h"

namespace boxwood {

#define BOXWOOD_LOOPS "boxwood/scene/surface_block-inl.h"
#include "boxwood/core/every_cpu-inl.h"

void SurfaceBlock::set(int i, const Surface& surface) {
  position.set(i, surface.position);
  error.set(i, surface.error);
  normal.set(i, surface.normal);
  shading_normal.set(i, surface.shading_normal);
  uv.set(i, surface.uv);
  second_uv.set(i, surface.second_uv);
  clearance[i] = surface.clearance();
  material[i] = surface.material;
}

SurfaceReader::SurfaceReader(const Scene& scene) : scene_(scene) {
  const Scene::Parts& parts = scene.parts();
  for (std::size_t i = 0; i < parts.instances.size(); ++i) {
    const Instance& instance = parts.instances[i];
    const Geometry& geometry = parts.desc.geometries[instance.geometry.value];
    Mesh& mesh = meshes_.emplace_back();
    mesh.material = instance.material.is_valid() ? instance.material : geometry.material;
    if (!instance.material.is_valid() && !geometry.materials.empty())
      mesh.materials = geometry.materials.data();
    mesh.is_moved = parts.is_moved[i] != 0;
    if (const auto* triangles = std::get_if<TriangleMesh>(&geometry.shapes)) {
      mesh.indices = triangles->indices.data();
      mesh.positions = triangles->positions.data();
      if (!triangles->normals.empty()) mesh.normals = triangles->normals.data();
      if (!triangles->uvs.empty()) mesh.uvs = triangles->uvs.data();
      mesh.has_colors = !triangles->colors.empty();
      if (!triangles->second_uvs.empty()) mesh.second_uvs = triangles->second_uvs.data();
    }
  }
}

void SurfaceReader::prefetch_triangle(const Hit& hit) const {
  if (!hit) return;
  const Mesh& mesh = meshes_[hit.instance_id.value];
  if (mesh.indices != nullptr) prefetch(&mesh.indices[hit.primitive_id.value]);
}

void SurfaceReader::prefetch_corners(const Hit& hit) const {
  if (!hit) return;
  const Mesh& mesh = meshes_[hit.instance_id.value];
  if (mesh.indices == nullptr) return;
  for (const std::uint32_t vertex : mesh.indices[hit.primitive_id.value]) {
    prefetch(&mesh.positions[vertex]);
    if (mesh.normals != nullptr) prefetch(&mesh.normals[vertex]);
    if (mesh.uvs != nullptr) prefetch(&mesh.uvs[vertex]);
  }
}

void SurfaceReader::read(std::span<const Ray> rays, std::span<const Hit> hits,
                         std::span<const std::uint32_t> which, SurfaceBlock& out) const {
  const int count = static_cast<int>(which.size());
  Corners corners;
  bool is_any_other = false;
  for (int i = 0; i < count; ++i) {
    const Hit& hit = hits[which[i]];
    const Mesh& mesh = meshes_[hit.instance_id.value];
    is_any_other |= mesh.indices == nullptr || mesh.is_moved || mesh.second_uvs != nullptr;
    out.normal.set(i, hit.normal);
    if (mesh.indices == nullptr) continue;
    out.material[i] = mesh.materials != nullptr ? mesh.materials[hit.primitive_id.value] : mesh.material;
    corners.weights.set(i, {hit.u, hit.v});
    corners.has_normals[i] = mesh.normals != nullptr ? 1 : 0;
    corners.has_uvs[i] = mesh.uvs != nullptr ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.indices[hit.primitive_id.value][k];
      corners.positions[k].set(i, mesh.positions[vertex]);
      if (mesh.normals != nullptr) corners.normals[k].set(i, mesh.normals[vertex]);
      if (mesh.uvs != nullptr) corners.uvs[k].set(i, mesh.uvs[vertex]);
    }
  }
  BOXWOOD_BEST(place_block)(corners, out);

  // What the loop does not know, one by one.
  for (int i = 0; i < count && is_any_other; ++i) {
    const std::uint32_t at = which[i];
    const Hit& hit = hits[at];
    const Mesh& mesh = meshes_[hit.instance_id.value];
    if (mesh.indices == nullptr || mesh.is_moved) {
      out.set(i, surface_at(scene_, rays[at], hit));
      out.uv_density[i] = uv_density(scene_, hit);
      out.second_uv_density[i] = uv_density(scene_, hit, true);
    } else if (mesh.second_uvs != nullptr) {
      const auto& [a, b, c] = mesh.indices[hit.primitive_id.value];
      out.second_uv.set(i, blend(mesh.second_uvs[a], mesh.second_uvs[b], mesh.second_uvs[c], hit.u, hit.v));
      out.second_uv_density[i] = uv_density(scene_, hit, true);
    }
  }
}

}  // namespace boxwood
