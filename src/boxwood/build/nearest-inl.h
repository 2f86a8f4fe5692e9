// nearest-inl.h: how are sixteen neighbours compared at once?
//
// Included once for each instruction set, in a namespace of its own; no include guard.

#if defined(__GNUC__) && !defined(__clang__)  // clang 14 refuses eight lanes where there is no AVX
struct Eight {
  using Floats = float __attribute__((vector_size(32)));
  using Bits = std::int32_t __attribute__((vector_size(32)));
  Floats v;

  static Eight load(const float* from) {
    Eight eight;
    std::memcpy(&eight.v, from, sizeof eight.v);
    return eight;
  }
  static Eight all(float f) { return {Floats{f, f, f, f, f, f, f, f}}; }
  friend Eight max(Eight a, Eight b) { return {a.v > b.v ? a.v : b.v}; }
  friend Eight min(Eight a, Eight b) { return {a.v < b.v ? a.v : b.v}; }
  friend Eight operator+(Eight a, Eight b) { return {a.v + b.v}; }
  friend Eight operator*(Eight a, Eight b) { return {a.v * b.v}; }
  /// The four lowest bits of each number replaced.
  Eight with_low_bits(const std::int32_t* low) const {
    Bits bits;
    std::memcpy(&bits, low, sizeof bits);
    return {std::bit_cast<Floats>((std::bit_cast<Bits>(v) & ~15) | bits)};
  }
  float least() const {
    Floats m = v;
    Floats turned = __builtin_shufflevector(m, m, 4, 5, 6, 7, 0, 1, 2, 3);
    m = m < turned ? m : turned;
    turned = __builtin_shufflevector(m, m, 2, 3, 0, 1, 6, 7, 4, 5);
    m = m < turned ? m : turned;
    turned = __builtin_shufflevector(m, m, 1, 0, 3, 2, 5, 4, 7, 6);
    m = m < turned ? m : turned;
    return m[0];
  }
};
#else
struct Eight {
  float v[8];
  template <class Op>
  static Eight each(Op op) {
    return {{op(0), op(1), op(2), op(3), op(4), op(5), op(6), op(7)}};
  }
  static Eight load(const float* from) {
    return each([&](int k) { return from[k]; });
  }
  static Eight all(float f) {
    return each([&](int) { return f; });
  }
  friend Eight max(Eight a, Eight b) {
    return each([&](int k) { return a.v[k] > b.v[k] ? a.v[k] : b.v[k]; });
  }
  friend Eight min(Eight a, Eight b) {
    return each([&](int k) { return a.v[k] < b.v[k] ? a.v[k] : b.v[k]; });
  }
  friend Eight operator+(Eight a, Eight b) {
    return each([&](int k) { return a.v[k] + b.v[k]; });
  }
  friend Eight operator*(Eight a, Eight b) {
    return each([&](int k) { return a.v[k] * b.v[k]; });
  }
  Eight with_low_bits(const std::int32_t* low) const {
    return each(
        [&](int k) { return std::bit_cast<float>((std::bit_cast<std::int32_t>(v[k]) & ~15) | low[k]); });
  }
  float least() const { return *std::min_element(v, v + 8); }
};
#endif

inline void find_nearest(const BoxRow& row, float scale, std::uint16_t* partner) {
  const Eight factor = Eight::all(scale), little = Eight::all(0x1p-20f), huge = Eight::all(3e38f);
  for (std::uint32_t i = 0; i < row.count; ++i) {
    Eight own[6];
    for (int k = 0; k < 6; ++k) own[k] = Eight::all(row.plane[k][i]);
    const auto sizes = [&](std::ptrdiff_t first, const std::int32_t* low) {
      Eight side[3];
      for (int k = 0; k < 3; ++k)
        side[k] = (max(own[k], Eight::load(row.plane[k] + first)) +
                   max(own[k + 3], Eight::load(row.plane[k + 3] + first))) *
                  factor;
      const Eight area =
          side[0] * (side[1] + little) + side[1] * (side[2] + little) + side[2] * (side[0] + little);
      // Also what is infinite, or not a number, becomes huge.
      return min(area, huge).with_low_bits(low);
    };
    const LowBits& low = kLowBits[i % 16];
    const Eight before = sizes(std::ptrdiff_t(i) - kReach, low.before);
    const Eight behind = sizes(std::ptrdiff_t(i) + 1, low.behind);
    const auto least = std::bit_cast<std::uint32_t>(min(before, behind).least());
    partner[i] = static_cast<std::uint16_t>(int(i) + low.offset[least & 15]);
  }
}
