#include "boxwood/build/nearest.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

#include "boxwood/core/every_cpu.h"

namespace boxwood {
namespace {

/// Four bits that make all 16 sizes different, and say whose each is: three for the distance, and one that is
/// the same for both ends of a pair but differs between the two neighbours at one distance. Bit t of a
/// position, where 2^t is the largest power of two that divides the distance, differs between positions at
/// that distance; the lower end's decides.
struct LowBits {
  std::int32_t before[kReach], behind[kReach];
  std::int8_t offset[16];
};
constexpr std::array<LowBits, 16> make_low_bits() {
  std::array<LowBits, 16> table{};
  for (int i = 0; i < 16; ++i)
    for (int distance = 1; distance <= kReach; ++distance) {
      const int bit = i >> std::countr_zero(unsigned(distance)) & 1;
      const int behind = (distance - 1) << 1 | bit, before = behind ^ 1;
      table[i].behind[distance - 1] = behind;
      table[i].before[kReach - distance] = before;
      table[i].offset[behind] = static_cast<std::int8_t>(distance);
      table[i].offset[before] = static_cast<std::int8_t>(-distance);
    }
  return table;
}
constexpr std::array<LowBits, 16> kLowBits = make_low_bits();

}  // namespace

#define BOXWOOD_LOOPS "boxwood/build/nearest-inl.h"
#include "boxwood/core/every_cpu-inl.h"

void find_nearest(const BoxRow& row, const Scale& scale, std::uint16_t* partner) {
  BOXWOOD_BEST(find_nearest)(row, scale.factor(), partner);
}

}  // namespace boxwood
