// ray_order.h: is a large batch worth putting in order, and in which order is it answered?
//
// Rays that begin close together and go the same way read the same nodes. Where a tree outgrows the caches
// and each ray visits much of it, as in a soup of triangles that overlap, random rays are answered a third
// faster when they come sorted by direction and origin, the sort included. Elsewhere the sort, and the way
// there and back, cost more than they save: a ray in a smooth scene takes less time than its sorting, and
// rays from the points of a picture are in order as they come. Inside the scene room only.
#pragma once

#include <span>

#include "boxwood/core/parallel.h"
#include "boxwood/core/ray.h"

namespace boxwood::detail {

/// So much of a batch is sorted at once, and no less is worth it.
constexpr std::size_t kMostSorted = std::size_t(1) << 20, kLeastSorted = std::size_t(1) << 16;

/// Whether rays through a tree of this size and SAH cost (tree/metrics.h) wait so long for its nodes that
/// order may help.
bool may_be_worth_sorting(std::size_t tree_bytes, float sah_cost);

/// Whether neighbours among `rays` begin far apart, compared with `bounds`: by a sample of 64 pairs.
bool are_scattered(std::span<const Ray> rays, const Box3& bounds);

/// Writes into the lower 32 bits of `order` the numbers of `rays`, those that go the same way and begin close
/// together next to each other: by octant of the direction, and along a Morton curve of 16 cells an axis of
/// `bounds`. Precondition: as many of both, at most kMostSorted. Cost: linear, about 20 ns a ray on one
/// thread; memory: 8 bytes a ray.
void find_ray_order(std::span<const Ray> rays, const Box3& bounds, std::span<std::uint64_t> order,
                    Executor& executor);

}  // namespace boxwood::detail
