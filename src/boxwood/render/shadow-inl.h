// shadow-inl.h: the loop of shadow.cpp.
//
// Included once for each instruction set, in a namespace of its own; no include guard.

/// Marks the rays that may meet something in `box`. Hits stray from the ray by a few units in the last place
/// of what is added up, and so does what is worked out here; the slack is many times that. `reach` is the
/// largest coordinate in the scene. Where a slab gives no number, only by an infinite plane, all else
/// decides.
inline void meet_boxes(const Box3& box, float reach, const RayBlock& __restrict rays,
                       Integers& __restrict meets) {
  const Vec3 lower = box.lower, upper = box.upper;
  for (int i = 0; i < kBlock; ++i) {
    const Vec3 origin = rays.origin[i], direction = rays.direction[i];
    const float slack = (reach + max_component(abs(origin))) * 0x1p-18f;
    float entry = 0, exit = rays.t_max[i];
    const auto cut = [&](float o, float d, float low, float high) {
      const float inverse = 1 / d;
      const float a = (low - slack - o) * inverse, b = (high + slack - o) * inverse;
      entry = max(min(a, b), entry);
      exit = min(max(a, b), exit);
    };
    cut(origin.x, direction.x, lower.x, upper.x);
    cut(origin.y, direction.y, lower.y, upper.y);
    cut(origin.z, direction.z, lower.z, upper.z);
    meets[i] |= entry <= exit ? 1u : 0u;
  }
}
