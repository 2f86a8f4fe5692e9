// surface_block.h: what is it like where many rays hit?
//
// As surface_at() for each of a block of hits (core/block.h), with the same answers. What the corners of the
// triangles hold is gathered into arrays; the rest are loops over these. Hits on other shapes, and under a
// transform, go one by one.
#pragma once

#include "boxwood/core/block.h"
#include "boxwood/scene/surface.h"

namespace boxwood {

/// The surfaces of a block, quantity by quantity.
struct SurfaceBlock {
  Vec3s position, error, normal, shading_normal;
  Vec2s uv, second_uv;
  Floats clearance{};   ///< As Surface::clearance().
  Floats uv_density{};  ///< How much of uv, on a side, a square of the world of side 1 covers; 0: not known.
  Floats second_uv_density{};
  std::array<MaterialId, kBlock> material;

  Surface operator[](int i) const {
    return {position[i], error[i], normal[i], shading_normal[i], uv[i], second_uv[i], material[i]};
  }
  void set(int i, const Surface& surface);
};

/// What the corners of a block's triangles hold.
struct Corners {
  std::array<Vec3s, 3> positions, normals;
  std::array<Vec2s, 3> uvs;
  Integers has_normals{}, has_uvs{};
  Vec2s weights;  ///< Of the second and the third.
};

/// Reads surfaces of one scene. Its own memory, a line of the cache for each instance, says where the
/// triangles are: a hit leads there by one step.
class SurfaceReader {
 public:
  /// Keeps a reference.
  explicit SurfaceReader(const Scene& scene);

  /// Brings what read() will want for `hit` nearer to the processor, in two steps with some other work after
  /// each: first where the triangle's corners are named, then the corners. Does nothing for a miss.
  void prefetch_triangle(const Hit& hit) const;
  void prefetch_corners(const Hit& hit) const;

  /// As the function of this name (surface.h). Not for a miss.
  std::array<float, 4> vertex_color(const Hit& hit) const {
    const Mesh& mesh = meshes_[hit.instance_id.value];
    return mesh.has_colors ? boxwood::vertex_color(scene_, hit) : std::array<float, 4>{1, 1, 1, 1};
  }

  /// Place `i` of the block is for `hits[which[i]]`, which the scene returned for `rays[which[i]]`. At most
  /// kBlock, none of them a miss.
  void read(std::span<const Ray> rays, std::span<const Hit> hits, std::span<const std::uint32_t> which,
            SurfaceBlock& out) const;

 private:
  /// The mesh of an instance.
  struct alignas(64) Mesh {
    const std::array<std::uint32_t, 3>* indices = nullptr;  ///< Null where there is none.
    const Vec3* positions = nullptr;
    const Vec3* normals = nullptr;
    const Vec2* uvs = nullptr;
    const Vec2* second_uvs = nullptr;
    const MaterialId* materials = nullptr;  ///< One for each triangle; null: all have this one.
    MaterialId material;
    bool is_moved = false, has_colors = false;
  };

  const Scene& scene_;
  std::vector<Mesh> meshes_;  // InstanceId ->
};

}  // namespace boxwood
