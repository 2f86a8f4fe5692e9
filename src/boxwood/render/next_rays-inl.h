// next_rays-inl.h: the loops of next_rays.h.
//
// Included once for each instruction set, in a namespace of its own; no include guard.

inline void ask_for_light(const PathPoints& __restrict paths, const Scattered& __restrict scattered,
                          const LightSamples& __restrict lights, NextRays& __restrict out) {
  for (int i = 0; i < kBlock; ++i) {
    const Vec3 value = scattered.toward_value[i];
    const float pdf = lights.pdf[i];
    const float heuristic = power_heuristic(pdf, scattered.toward_pdf[i]);
    const float weight = lights.is_perfect[i] != 0 ? 1.0f : heuristic;
    out.light.set(i, paths.throughput[i] * value * lights.radiance[i] * (weight / pdf));
    out.asks_for_light[i] = (paths.is_spread[i] != 0) & (pdf > 0) & (max_component(value) > 0) ? 1u : 0u;
  }
}

inline void go_on(const PathPoints& __restrict paths, const SurfaceBlock& __restrict surfaces,
                  const Scattered& __restrict scattered, NextRays& __restrict out) {
  for (int i = 0; i < kBlock; ++i) {
    // Russian roulette: end paths that carry little, and let the others stand for them.
    const Vec3 carried = paths.throughput[i] * scattered.weight[i];
    const float survival = min(max_component(carried), kMaxSurvival);
    const bool in_roulette = paths.in_roulette[i] != 0;
    const bool survives = !in_roulette | (paths.chance[i] < survival);
    const Vec3 throughput = carried * (in_roulette ? 1 / survival : 1.0f);
    out.throughput.set(i, throughput);
    out.goes_on[i] = (scattered.has_next[i] != 0) & survives & (max_component(throughput) > 0) ? 1u : 0u;

    // As Surface::spawn().
    const Vec3 normal = surfaces.normal[i];
    const float clearance = surfaces.clearance[i];
    const float side = dot(normal, scattered.direction[i]) < 0 ? -clearance : clearance;
    out.origin.set(i, surfaces.position[i] + normal * side);
  }
}
