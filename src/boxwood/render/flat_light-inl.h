// flat_light-inl.h: the loop of flat_light.h.
//
// Included once for each instruction set, in a namespace of its own; no include guard.

inline void sample_flat_block(const FlatLight* __restrict lights, const Integers& index,
                              const Floats& probability, const SurfaceBlock& from, const Vec2s& u,
                              LightSamples& __restrict out) {
  for (int i = 0; i < kBlock; ++i) {
    const FlatLight& light = lights[index[i]];
    // The square folded onto the triangle, as by uniform_triangle() (warp.h).
    const float folded = light.is_triangle * 0.5f * min(u.x[i], u.y[i]);
    const bool is_upper = u.y[i] > u.x[i];
    const float along_x = (is_upper & (light.is_triangle > 0)) ? folded : u.x[i] - folded;
    const float along_y = (is_upper | (light.is_triangle == 0)) ? u.y[i] - folded : folded;
    const Vec3 position = light.corner + light.x * along_x + light.y * along_y;

    const Vec3 to_light = position - from.position[i];
    const float distance_squared = length_squared(to_light);
    const Vec3 direction = to_light / std::sqrt(distance_squared);
    const float cosine = -dot(direction, light.normal), slant = std::fabs(cosine);
    const float pdf = probability[i] * (light.density * distance_squared / slant);
    const bool is_lit = (cosine > 0) | (light.is_two_sided > 0);
    // Anything that is not finite makes this sum so.
    const float reach = std::fabs(direction.x) + std::fabs(direction.y) + std::fabs(direction.z);
    const bool is_usable = is_lit & (pdf > 0) & (pdf < kInfinity) & (reach < kInfinity);
    out.pdf[i] = is_usable ? pdf : 0.0f;

    // From where a ray leaves the surface to just before the light itself, where a ray from there would
    // start.
    const float side = dot(from.normal[i], direction) < 0 ? -from.clearance[i] : from.clearance[i];
    const Vec3 origin = from.position[i] + from.normal[i] * side;
    const Vec3 end = position + light.normal * (cosine > 0 ? light.clearance : -light.clearance);
    const Vec3 way = end - origin;
    out.direction.set(i, direction);
    out.radiance.set(i, light.radiance);
    out.shadow_rays.origin.set(i, origin);
    out.shadow_rays.direction.set(i, way);
    out.shadow_rays.t_max[i] = 1;
    out.is_perfect[i] = 0;
  }
}
