// surface_block-inl.h: the loop of surface_block.h.
//
// Included once for each instruction set, in a namespace of its own; no include guard.

inline void place_block(const Corners& __restrict corners, SurfaceBlock& __restrict out) {
  for (int i = 0; i < kBlock; ++i) {
    const float v = corners.weights.x[i], w = corners.weights.y[i];
    const Triangle triangle{corners.positions[0][i], corners.positions[1][i], corners.positions[2][i]};
    const BoundedPoint point = point_of_triangle(triangle, v, w);
    const Vec3 normal = out.normal[i];
    out.position.set(i, point.position);
    out.error.set(i, point.error);
    out.clearance[i] = clearance_of(point.position, point.error, normal);
  }
  for (int i = 0; i < kBlock; ++i) {
    const float v = corners.weights.x[i], w = corners.weights.y[i];
    const Vec3 a = corners.normals[0][i], b = corners.normals[1][i], c = corners.normals[2][i];
    const Vec3 normal = out.normal[i];
    out.shading_normal.set(i, shading_normal_of(blend(a, b, c, v, w), normal, corners.has_normals[i] != 0));
  }
  for (int i = 0; i < kBlock; ++i) {
    const float v = corners.weights.x[i], w = corners.weights.y[i];
    const Vec2 a = corners.uvs[0][i], b = corners.uvs[1][i], c = corners.uvs[2][i];
    const Vec2 uv = blend(a, b, c, v, w);
    const bool has_uvs = corners.has_uvs[i] != 0;
    out.uv.set(i, {has_uvs ? uv.x : v, has_uvs ? uv.y : w});
    const Vec3 p = corners.positions[0][i];
    const float density = uv_density_of(corners.positions[1][i] - p, corners.positions[2][i] - p,
                                        {b.x - a.x, b.y - a.y}, {c.x - a.x, c.y - a.y});
    out.uv_density[i] = has_uvs ? density : 0.0f;
  }
  // A mesh with a second set is not for this loop.
  out.second_uv = out.uv;
  out.second_uv_density = out.uv_density;
}
