// lanes.h: how are four floats worked on at once?
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

/// For a few functions that vectors go through: called, they would pass them through memory.
#if defined(__GNUC__)
#define BOXWOOD_ALWAYS_INLINE [[gnu::always_inline]] inline
#else
#define BOXWOOD_ALWAYS_INLINE inline
#endif

namespace boxwood {

/// Four floats that are worked on together; the fourth is there for the alignment and stays 0 or -inf. With
/// gcc and clang they are one vector register, elsewhere a compiler has to find that out by itself.
struct Lanes {
#if defined(__GNUC__)
  using Register = float __attribute__((vector_size(16)));
  using Bits = std::int32_t __attribute__((vector_size(16)));
  Register v;

  friend Lanes max(Lanes a, Lanes b) {
    return {a.v > b.v ? a.v : b.v};
  }
  friend Lanes min(Lanes a, Lanes b) {
    return {a.v < b.v ? a.v : b.v};
  }
  friend Lanes operator+(Lanes a, Lanes b) {
    return {a.v + b.v};
  }
  friend Lanes operator-(Lanes a, Lanes b) {
    return {a.v - b.v};
  }
  friend Lanes operator*(Lanes a, Lanes b) {
    return {a.v * b.v};
  }
  Lanes with_fourth_zero() const {
    return {std::bit_cast<Register>(std::bit_cast<Bits>(v) & Bits{-1, -1, -1, 0})};
  }
  /// `a` where `left` is less than `right`, elsewhere `b`.
  friend Lanes select_less(Lanes left, Lanes right, Lanes a, Lanes b) {
    return {left.v < right.v ? a.v : b.v};
  }
  friend Lanes operator/(Lanes a, Lanes b) {
    return {a.v / b.v};
  }
  /// The same sizes with other signs.
  Lanes with_signs_of(Lanes other) const {
    constexpr std::int32_t kSign = std::int32_t(0x80000000u);
    return {
        std::bit_cast<Register>((std::bit_cast<Bits>(v) & ~kSign) | (std::bit_cast<Bits>(other.v) & kSign))};
  }
  /// Where `which` has all bits set, `a` and `b` change places.
  friend void swap_where(Lanes which, Lanes& a, Lanes& b) {
    const Bits bits_a = std::bit_cast<Bits>(a.v), bits_b = std::bit_cast<Bits>(b.v);
    const Bits change = (bits_a ^ bits_b) & std::bit_cast<Bits>(which.v);
    a.v = std::bit_cast<Register>(bits_a ^ change);
    b.v = std::bit_cast<Register>(bits_b ^ change);
  }
  /// Lanes 1, 2, 3, 3; and 2, 3, 2, 3.
  Lanes from_second() const {
    return {__builtin_shufflevector(v, v, 1, 2, 3, 3)};
  }
  Lanes high() const {
    return {__builtin_shufflevector(v, v, 2, 3, 2, 3)};
  }
  /// The first two lanes of both in turns, and the last two.
  friend Lanes zip_low(Lanes a, Lanes b) {
    return {__builtin_shufflevector(a.v, b.v, 0, 4, 1, 5)};
  }
  friend Lanes zip_high(Lanes a, Lanes b) {
    return {__builtin_shufflevector(a.v, b.v, 2, 6, 3, 7)};
  }
  /// Cut towards 0. Precondition: they fit.
  std::array<std::int32_t, 4> whole() const {
    return std::bit_cast<std::array<std::int32_t, 4>>(__builtin_convertvector(v, Bits));
  }
  /// Rounded down. Precondition: not negative, and fits an int.
  friend Lanes floor_of(Lanes a) {
    return {__builtin_convertvector(__builtin_convertvector(a.v, Bits), Register)};
  }
  static Lanes from(const std::int32_t (&whole)[4]) {
    Bits bits;
    std::memcpy(&bits, whole, sizeof bits);
    return {__builtin_convertvector(bits, Register)};
  }
  /// (y, z, x): what the x, y and z of a box's extent are multiplied with to get the areas of its sides.
  Lanes turned() const {
    return {__builtin_shufflevector(v, v, 1, 2, 0, 3)};
  }
  /// Lane k is the sum of the first three lanes of the k-th argument, (0 + 1) + 2.
  friend Lanes sums_of_three(Lanes a, Lanes b, Lanes c) {
    const Register low = __builtin_shufflevector(a.v, b.v, 0, 4, 1, 5);
    const Register high = __builtin_shufflevector(a.v, b.v, 2, 6, 3, 7);
    return {__builtin_shufflevector(low, c.v, 0, 1, 4, 4) + __builtin_shufflevector(low, c.v, 2, 3, 5, 5) +
            __builtin_shufflevector(high, c.v, 0, 1, 6, 6)};
  }
#else
  struct alignas(16) Register {
    float f[4];
    float operator[](int k) const { return f[k]; }
  };
  Register v;

  template <class Op>
  static Lanes each(Op op) {
    return {Register{op(0), op(1), op(2), op(3)}};
  }
  // clang-format off
  friend Lanes max(Lanes a, Lanes b) { return each([&](int k) { return a.v[k] > b.v[k] ? a.v[k] : b.v[k]; }); }
  friend Lanes min(Lanes a, Lanes b) { return each([&](int k) { return a.v[k] < b.v[k] ? a.v[k] : b.v[k]; }); }
  friend Lanes operator+(Lanes a, Lanes b) { return each([&](int k) { return a.v[k] + b.v[k]; }); }
  friend Lanes operator-(Lanes a, Lanes b) { return each([&](int k) { return a.v[k] - b.v[k]; }); }
  friend Lanes operator*(Lanes a, Lanes b) { return each([&](int k) { return a.v[k] * b.v[k]; }); }
  Lanes with_fourth_zero() const { return each([&](int k) { return k < 3 ? v[k] : 0.0f; }); }
  friend Lanes select_less(Lanes left, Lanes right, Lanes a, Lanes b) {
    return each([&](int k) { return left.v[k] < right.v[k] ? a.v[k] : b.v[k]; });
  }
  std::array<std::int32_t, 4> whole() const {
    return {std::int32_t(v[0]), std::int32_t(v[1]), std::int32_t(v[2]), std::int32_t(v[3])};
  }
  friend Lanes floor_of(Lanes a) { return each([&](int k) { return float(std::int32_t(a.v[k])); }); }
  static Lanes from(const std::int32_t (&whole)[4]) { return each([&](int k) { return float(whole[k]); }); }
  friend Lanes operator/(Lanes a, Lanes b) { return each([&](int k) { return a.v[k] / b.v[k]; }); }
  Lanes with_signs_of(Lanes other) const { return each([&](int k) { return std::copysign(v[k], other.v[k]); }); }
  friend void swap_where(Lanes which, Lanes& a, Lanes& b) {
    for (int k = 0; k < 4; ++k)
      if (std::bit_cast<std::uint32_t>(which.v[k]) != 0) std::swap(a.v.f[k], b.v.f[k]);
  }
  Lanes from_second() const { return {Register{v[1], v[2], v[3], v[3]}}; }
  Lanes high() const { return {Register{v[2], v[3], v[2], v[3]}}; }
  friend Lanes zip_low(Lanes a, Lanes b) { return {Register{a.v[0], b.v[0], a.v[1], b.v[1]}}; }
  friend Lanes zip_high(Lanes a, Lanes b) { return {Register{a.v[2], b.v[2], a.v[3], b.v[3]}}; }
  Lanes turned() const { return {Register{v[1], v[2], v[0], v[3]}}; }
  friend Lanes sums_of_three(Lanes a, Lanes b, Lanes c) {
    const auto sum = [](const Register& r) { return r[0] + r[1] + r[2]; };
    return {Register{sum(a.v), sum(b.v), sum(c.v), sum(c.v)}};
  }
  // clang-format on
#endif
  static Lanes all(float f) {
    return {Register{f, f, f, f}};
  }
  /// The four floats from `p` on.
  static Lanes load(const void* p) {
    Lanes lanes;
    std::memcpy(&lanes.v, p, sizeof lanes.v);
    return lanes;
  }
  void store(void* p) const {
    std::memcpy(p, &v, sizeof v);
  }
};

}  // namespace boxwood
