// exact_sum.h: how are floats added so that their order does not matter?
//
// Floating-point addition is not associative, so sums that threads, machines or interrupted runs add up in
// another order differ in their last bits. Here a float is cut into two whole numbers, its digits in base
// 2^40, and digits are added as integers, which is associative. A sum keeps the digits of two neighbouring
// places, and moves up when a larger float arrives: what then falls off below is the same digit for digit as
// if the large one had come first (Demmel and Nguyen, "Parallel Reproducible Summation", 2015).
//
// Invariants: the sum of a set of at most 2^20 floats is the same for every order and grouping, and within
// 2^-40 of its largest member times their number.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

namespace boxwood::render {

/// Numbers below 2^(40 (place - 3)) and not below 2^(40 (place - 4)) have their first digit at `place`.
inline int place_of(float x) {
  constexpr int kDigitBits = 40, kLowestExponent = -160;
  const int biased = static_cast<int>(std::bit_cast<std::uint32_t>(x) >> 23 & 255);
  const int exponent = biased == 0 ? -127 : biased - 127;  // those of denormals are lower, in the same place
  return (exponent - kLowestExponent) / kDigitBits;
}

inline constexpr int kHighestPlace = 7;

/// What a digit at `place` counts; `place` is -1 to kHighestPlace.
inline double unit_at(int place) {
  constexpr std::array<double, 9> kUnits{0x1p-200, 0x1p-160, 0x1p-120, 0x1p-80, 0x1p-40,
                                         0x1p0,    0x1p40,   0x1p80,   0x1p120};
  return kUnits[static_cast<std::size_t>(place + 1)];
}
/// 1 / unit_at(place).
inline double per_unit_at(int place) {
  constexpr std::array<double, 9> kPerUnit{0x1p200, 0x1p160, 0x1p120, 0x1p80,  0x1p40,
                                           0x1p0,   0x1p-40, 0x1p-80, 0x1p-120};
  return kPerUnit[static_cast<std::size_t>(place + 1)];
}

/// The digits of a sum at its upper place, and at the place below.
struct Digits {
  std::int64_t upper = 0, lower = 0;
  friend bool operator==(const Digits&, const Digits&) = default;
};

/// A double of at most 2^51 to the nearest whole number: adding 1.5 * 2^52 leaves no bits for a fraction.
inline std::int64_t nearest_whole(double x) {
  constexpr double kShift = 0x1.8p52;
  return static_cast<std::int64_t>((x + kShift) - kShift);
}

/// Moves sums that share an upper place up to `place`.
inline void lift(std::span<Digits> sums, std::uint8_t& upper_place, int place) {
  for (; upper_place < place; ++upper_place)
    for (Digits& sum : sums) sum = {0, sum.upper};
}

/// Adds one float to each sum, times `sign` (1 or -1). The sums share one upper place. All must be finite.
inline void add_exactly(std::span<Digits> sums, std::uint8_t& upper_place, std::span<const float> values,
                        int sign) {
  int largest = 0;
  for (const float value : values) largest = place_of(value) > largest ? place_of(value) : largest;
  lift(sums, upper_place, largest);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    // Without branches: light is as often above 1 as below, which is where places meet.
    const int place = place_of(values[i]);
    const double value = values[i];
    const std::int64_t first = nearest_whole(value * per_unit_at(place));
    const double rest = value - static_cast<double>(first) * unit_at(place);
    const auto second = static_cast<std::int64_t>(rest * per_unit_at(place - 1));
    const std::int64_t is_upper = -std::int64_t(place == upper_place);
    const std::int64_t is_lower = -std::int64_t(place == upper_place - 1);
    sums[i].upper += sign * (first & is_upper);
    sums[i].lower += sign * ((first & is_lower) | (second & is_upper));
  }
}

/// Adds sums to sums.
inline void add_exactly(std::span<Digits> sums, std::uint8_t& upper_place, std::span<const Digits> others,
                        std::uint8_t others_place) {
  lift(sums, upper_place, others_place);
  const int below = upper_place - others_place;
  for (std::size_t i = 0; i < sums.size() && below < 2; ++i) {
    sums[i].upper += below == 0 ? others[i].upper : 0;
    sums[i].lower += below == 0 ? others[i].lower : others[i].upper;
  }
}

/// The sum as a number.
inline double value_of(Digits sum, std::uint8_t upper_place) {
  return static_cast<double>(sum.upper) * unit_at(upper_place) +
         static_cast<double>(sum.lower) * unit_at(upper_place - 1);
}

}  // namespace boxwood::render
