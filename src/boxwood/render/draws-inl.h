// draws-inl.h: the loop of draws.h.
//
// Included once for each instruction set, in a namespace of its own; no include guard.

inline void draw_block(const Integers& pixel_seed, const Integers& reversed_index, const Integers& dimension,
                       std::uint32_t skipped, Vec2s& out) {
  for (int i = 0; i < kBlock; ++i) {
    const Vec2 pair = draw(pixel_seed[i], reversed_index[i], dimension[i] + skipped);
    out.x[i] = pair.x;
    out.y[i] = pair.y;
  }
}
