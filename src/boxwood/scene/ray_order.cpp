#include "boxwood/scene/ray_order.h"

#include <algorithm>
#include <cmath>

#include "boxwood/core/morton.h"
#include "boxwood/core/radix_sort.h"

namespace boxwood::detail {
namespace {

constexpr std::uint32_t kCells = 16, kCodeBits = 12;

/// Which of kCells the place is in; NaN goes to the first. Precise enough for an order, and quick.
std::uint32_t cell_at(float place) {
  constexpr float kLast = kCells - 1;
  return place > 0 ? static_cast<std::uint32_t>(std::min(place, kLast)) : 0;
}

}  // namespace

bool may_be_worth_sorting(std::size_t tree_bytes, float sah_cost) {
  // Measured in between: smooth meshes have costs of 5 to 10, soups of a hundred thousand and a million
  // triangles 43 and 104, of which the first, at 5 MB, gains nothing.
  return tree_bytes >= std::size_t(24) << 20 && sah_cost >= 48;
}

bool are_scattered(std::span<const Ray> rays, const Box3& bounds) {
  constexpr std::size_t kPairs = 64;
  if (rays.size() < 2 * kPairs) return false;
  const Vec3 size = bounds.extent();
  std::size_t far_apart = 0;
  for (std::size_t i = 0; i < kPairs; ++i) {
    const Ray* pair = &rays[i * (rays.size() - 1) / kPairs];
    const Vec3 way = abs(pair[1].origin - pair[0].origin);
    far_apart += way.x > size.x / 8 || way.y > size.y / 8 || way.z > size.z / 8;
  }
  return far_apart > kPairs * 7 / 8;
}

void find_ray_order(std::span<const Ray> rays, const Box3& bounds, std::span<std::uint64_t> order,
                    Executor& executor) {
  constexpr std::size_t kGrain = 1 << 13;
  const Vec3 size = bounds.extent();
  const Vec3 scale{kCells / size.x, kCells / size.y, kCells / size.z};
  parallel_for(executor, 0, (rays.size() + kGrain - 1) / kGrain, 1, [&](std::size_t part) {
    const std::size_t end = std::min((part + 1) * kGrain, rays.size());
    for (std::size_t i = part * kGrain; i < end; ++i) {
      std::uint32_t key = 0;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t cell = cell_at((rays[i].origin[k] - bounds.lower[k]) * scale[k]);
        const std::uint32_t is_backward = std::signbit(rays[i].direction[k]);
        key |= spread_bits_by_3(cell) << k | is_backward << (kCodeBits + k);
      }
      order[i] = std::uint64_t(key) << 32 | i;
    }
  });
  radix_sort_from_bit(32, order, executor);
}

}  // namespace boxwood::detail
