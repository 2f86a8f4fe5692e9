// plain_block-inl.h: the loops of plain_block.h.
//
// Included once for each instruction set, in a namespace of its own; no include guard. The order of
// operations is that of bsdf.cpp.

/// What the boundary reflects in all, of light at each cosine. Tables are read one by one, by no vectors.
inline void boundary_albedos(const PlainPoints& __restrict p, const Floats& cosines, Floats& __restrict out) {
  std::array<std::int32_t, kBlock> below;
  Floats share, lower, upper;
  for (int i = 0; i < kBlock; ++i) {
    const AlbedoRow::Place place(cosines[i]);
    below[i] = place.below;
    share[i] = place.share;
  }
  for (int i = 0; i < kBlock; ++i) {
    lower[i] = p.rows[i]->knot(below[i]);
    upper[i] = p.rows[i]->knot(below[i] + 1);
  }
  for (int i = 0; i < kBlock; ++i) out[i] = lower[i] * (1 - share[i]) + upper[i] * share[i];
}

/// The frame of each point.
inline void set_frames(PlainPoints& __restrict p) {
  for (int i = 0; i < kBlock; ++i) {
    const Vec3 outgoing = p.outgoing_world[i], normal = p.normal[i], shading = p.shading_normal[i];
    const float side = dot(normal, outgoing) < 0 ? -1.0f : 1.0f;
    const Vec3 geometric = normal * side, shaded = shading * side;
    const bool is_towards = dot(shaded, outgoing) > 1e-3f;
    const Vec3 z{is_towards ? shaded.x : geometric.x, is_towards ? shaded.y : geometric.y,
                 is_towards ? shaded.z : geometric.z};
    Vec3 x, y;
    orthonormal_basis(z, x, y);
    const Vec3 local{dot(x, outgoing), dot(y, outgoing), min(max(dot(z, outgoing), 1e-5f), 1.0f)};
    p.geometric.set(i, geometric);
    p.x_axis.set(i, x);
    p.y_axis.set(i, y);
    p.z_axis.set(i, z);
    p.outgoing.set(i, local);
  }
}

/// The light that each lobe gets, by what the boundary reflects on the way out.
inline void set_shares(PlainPoints& __restrict p, const Floats& __restrict albedos) {
  for (int i = 0; i < kBlock; ++i) {
    const Vec3 color = p.color[i];
    const bool has_boundary = p.boundary[i] > 0;
    const float mean = p.mean[i];
    const float reflected = p.boundary[i] * albedos[i];
    p.passes[i] = (1 - reflected) / (1 - p.boundary[i] * mean);
    const float leaves = (1 - mean) / (p.ior[i] * p.ior[i]);
    const Vec3 below = color * leaves / (splat(1) - color * (1 - leaves));
    const Vec3 diffuse{has_boundary ? below.x : color.x, has_boundary ? below.y : color.y,
                       has_boundary ? below.z : color.z};
    const float diffuse_chance = (1 - reflected) * max_component(diffuse);
    const float sum = reflected + diffuse_chance;
    p.diffuse.set(i, diffuse);
    p.specular_chance[i] = reflected / sum;
    p.diffuse_chance[i] = diffuse_chance / sum;
  }
}

inline void prepare_block(PlainPoints& p) {
  set_frames(p);
  Floats albedos;
  boundary_albedos(p, p.outgoing.z, albedos);
  set_shares(p, albedos);
}

/// What the lobes send to a point's viewer of the light from `incoming`, in its frame; `albedo` is that of
/// the boundary there. Nothing from below.
[[gnu::always_inline]] inline BsdfValue evaluate_plain(const PlainPoints& p, int i, Vec3 incoming,
                                                       float albedo, bool is_possible) {
  const Vec3 outgoing = p.outgoing[i], diffuse = p.diffuse[i], geometric = p.geometric[i];
  const float lambert = incoming.z / kPi;

  // The boundary.
  const Ggx ggx{p.alpha[i]};
  const Vec3 half = normalize(incoming + outgoing);
  const float cosine = min(dot(outgoing, half), 1.0f);
  const float fresnel = p.boundary[i] * fresnel_dielectric(cosine, p.ior[i]);
  const float specular = p.boundary[i] > 0 ? fresnel * ggx.reflection(outgoing, incoming, half) : 0.0f;
  const float specular_pdf =
      p.boundary[i] > 0 ? ggx.reflection_pdf(outgoing, half) * p.specular_chance[i] : 0.0f;

  // The base, below the boundary or bare.
  const Vec3 world = p.x_axis[i] * incoming.x + p.y_axis[i] * incoming.y + p.z_axis[i] * incoming.z;
  const float softened = shadow_softening(dot(geometric, p.z_axis[i]), dot(geometric, world), incoming.z);
  const float passes = p.passes[i] * (1 - p.boundary[i] * albedo);
  const float base = lambert * (p.boundary[i] > 0 ? passes : softened);

  const bool is_lit = is_possible & (incoming.z > 0);
  const Vec3 value = splat(specular) + diffuse * base;
  const float pdf = specular_pdf + lambert * p.diffuse_chance[i];
  return {{is_lit ? value.x : 0.0f, is_lit ? value.y : 0.0f, is_lit ? value.z : 0.0f}, is_lit ? pdf : 0.0f};
}

inline void evaluate_block(const PlainPoints& __restrict p, const Vec3s& __restrict directions,
                           Scattered& __restrict out) {
  Vec3s local;
  Floats albedos;
  for (int i = 0; i < kBlock; ++i) {
    const Vec3 to = directions[i];
    local.set(i, {dot(p.x_axis[i], to), dot(p.y_axis[i], to), dot(p.z_axis[i], to)});
  }
  boundary_albedos(p, local.z, albedos);
  for (int i = 0; i < kBlock; ++i) {
    // Nothing comes through the true surface, whatever the interpolated normal says.
    const bool is_possible = (dot(directions[i], p.geometric[i]) > 0) == (local.z[i] > 0);
    const BsdfValue found = evaluate_plain(p, i, local[i], albedos[i], is_possible);
    out.toward_value.set(i, found.value);
    out.toward_pdf[i] = found.pdf;
  }
}

inline void sample_block(const PlainPoints& __restrict p, const Floats& __restrict choices,
                         const Vec2s& __restrict u, Scattered& __restrict out) {
  Vec3s local;
  Floats albedos;
  for (int i = 0; i < kBlock; ++i) {
    const Vec3 outgoing = p.outgoing[i];
    const Vec3 half = Ggx{p.alpha[i]}.sample_visible_normal(outgoing, u[i]);
    const Vec3 mirrored = half * (2 * dot(outgoing, half)) - outgoing;
    const Vec3 spread = cosine_hemisphere(u[i]);
    const bool is_past_mirror = choices[i] >= p.specular_chance[i], has_base = p.diffuse_chance[i] > 0;
    const bool is_spread = is_past_mirror & has_base;
    local.set(i, {is_spread ? spread.x : mirrored.x, is_spread ? spread.y : mirrored.y,
                  is_spread ? spread.z : mirrored.z});
  }
  boundary_albedos(p, local.z, albedos);
  for (int i = 0; i < kBlock; ++i) {
    const Vec3 way = local[i];
    const Vec3 direction = normalize(p.x_axis[i] * way.x + p.y_axis[i] * way.y + p.z_axis[i] * way.z);
    const BsdfValue found = evaluate_plain(p, i, way, albedos[i], dot(direction, p.geometric[i]) > 0);
    out.direction.set(i, direction);
    out.weight.set(i, found.value / found.pdf);
    out.pdf[i] = found.pdf;
    out.has_next[i] = found.pdf > 0 ? 1u : 0u;
    out.is_perfect[i] = out.is_transmission[i] = 0;
  }
}

inline constexpr PlainKernels kKernels{prepare_block, evaluate_block, sample_block};
