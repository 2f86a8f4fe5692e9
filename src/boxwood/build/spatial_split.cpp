#include "boxwood/build/spatial_split.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "boxwood/core/morton.h"

namespace boxwood {
namespace {

constexpr std::size_t kBlock = 1 << 12;
constexpr std::uint32_t kCells = 1u << 20;

/// A plane on which the scene's halves, quarters, ... meet.
struct Plane {
  int axis = -1;  ///< -1: the box lies between all planes.
  int level = 0;  ///< Of 20: the cells on both sides are 2^level wide.
  float place = 0;
};

double area(const Box3& box) {
  const double x = double(box.upper.x) - box.lower.x, y = double(box.upper.y) - box.lower.y,
               z = double(box.upper.z) - box.lower.z;
  return x * y + y * z + z * x;
}

/// The half area without the largest side: what a box has beyond a flat one. Walls and floors fill their
/// boxes as well as anything does, and their pieces would only swell the nodes of what stands before them.
double bulk(const Box3& box) {
  if (box.is_empty()) return 0;
  const double x = double(box.upper.x) - box.lower.x, y = double(box.upper.y) - box.lower.y,
               z = double(box.upper.z) - box.lower.z;
  return x * y + y * z + z * x - std::max(x * y, std::max(y * z, z * x));
}

/// The sum of weight(i) over all boxes that are not empty: by blocks, so that it is the same for any number
/// of threads.
template <class Weight>
double sum_over(std::span<const Box3> boxes, Executor& executor, const Weight& weight) {
  std::vector<double> sums((boxes.size() + kBlock - 1) / kBlock, 0);
  parallel_for(executor, 0, sums.size(), 1, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < std::min(boxes.size(), (block + 1) * kBlock); ++i)
      if (!boxes[i].is_empty()) sums[block] += weight(i);
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

Box3 bounds_of(std::span<const Box3> boxes) {
  Box3 bounds;
  for (const Box3& box : boxes)
    if (!box.is_empty()) bounds.extend(box);
  return bounds;
}

/// Primitives with more bulk than this are worth a look.
double mean_bulk(std::span<const Box3> boxes, Executor& executor) {
  return sum_over(boxes, executor, [&](std::size_t i) { return bulk(boxes[i]); }) / double(boxes.size());
}

class Splitter {
 public:
  Splitter(const Box3& bounds, const Clip& clip) : bounds_(bounds), clip_(clip) {
    const Vec3 half = bounds.upper * 0.5f - bounds.lower * 0.5f;
    size_ = 2.0 * double(max_component(half));
    cells_per_length_ = size_ > 0 ? kCells / size_ : 0;
  }

  /// The plane of the highest level that cuts the box; of several, the one across its longest side.
  Plane best_plane(const Box3& box) const {
    Plane best;
    float longest = 0;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t low = cell(box.lower[k], k), high = cell(box.upper[k], k);
      if (low == high) continue;
      const int level = std::bit_width(low ^ high) - 1;
      const auto place = static_cast<float>(bounds_.lower[k] + size_ * ((high >> level) << level) / kCells);
      if (!(box.lower[k] < place && place < box.upper[k])) continue;
      const float side = box.upper[k] * 0.5f - box.lower[k] * 0.5f;
      if (level > best.level || best.axis < 0 || (level == best.level && side > longest)) {
        best = {k, level, place};
        longest = side;
      }
    }
    return best;
  }

  /// How much a primitive should be cut, in any unit.
  double priority(PrimId id, const Box3& box) const {
    const Plane plane = best_plane(box);
    if (plane.axis < 0) return 0;
    Box3 left, right;
    cut(id, box, plane, left, right);
    const double spared = bulk(box) - bulk(left) - bulk(right);
    const double share_of_scene = spared / (size_ * size_) * (double(1u << plane.level) / kCells);
    return spared > 0 ? std::cbrt(static_cast<float>(share_of_scene)) : 0;
  }

  /// Appends the pieces of `box` after at most `cuts` cuts.
  void split(PrimId id, const Box3& box, std::size_t cuts, Pieces& out) const {
    const Plane plane = cuts > 0 ? best_plane(box) : Plane{};
    Box3 left, right;
    if (plane.axis >= 0) cut(id, box, plane, left, right);
    if (left.is_empty() || right.is_empty()) {
      out.boxes.push_back(box);
      out.owners.push_back(id);
      return;
    }
    // The longer piece gets more of the other cuts.
    const double a = longest_side(left), b = longest_side(right);
    const auto left_cuts = a + b > 0 ? static_cast<std::size_t>(double(cuts - 1) * (a / (a + b)) + 0.5) : 0;
    split(id, left, left_cuts, out);
    split(id, right, cuts - 1 - left_cuts, out);
  }

 private:
  static double longest_side(const Box3& box) { return max_component(box.upper * 0.5f - box.lower * 0.5f); }
  std::uint32_t cell(float x, int axis) const {
    const double place = (double(x) - bounds_.lower[axis]) * cells_per_length_;
    return place > 0 ? std::min(kCells - 1, static_cast<std::uint32_t>(place)) : 0;
  }
  void cut(PrimId id, const Box3& box, const Plane& plane, Box3& left, Box3& right) const {
    Box3 below = box, above = box;
    below.upper[plane.axis] = above.lower[plane.axis] = plane.place;
    left = intersect(clip_(id, below), below);
    right = intersect(clip_(id, above), above);
  }

  const Box3 bounds_;
  const Clip& clip_;
  double size_, cells_per_length_;
};

}  // namespace

bool may_pay_to_split(std::span<const Box3> boxes, Executor& executor) {
  constexpr double kBoxesOnALine = 6, kShareOfArea = 0.25;
  const double all = sum_over(boxes, executor, [&](std::size_t i) { return area(boxes[i]); });
  const Box3 bounds = bounds_of(boxes);
  if (bounds.is_empty() || all < kBoxesOnALine * area(bounds)) return false;
  const double mean = mean_bulk(boxes, executor);
  const double bulky =
      sum_over(boxes, executor, [&](std::size_t i) { return bulk(boxes[i]) > mean ? area(boxes[i]) : 0.0; });
  return bulky >= kShareOfArea * all && bulky > 0;
}

Pieces split_spatially(std::span<const Box3> boxes, const Clip& clip, float share, Executor& executor) {
  const Splitter splitter(bounds_of(boxes), clip);
  const std::size_t blocks = (boxes.size() + kBlock - 1) / kBlock;
  const auto block_end = [&](std::size_t block) { return std::min(boxes.size(), (block + 1) * kBlock); };

  // Weigh the bulky ones.
  std::vector<double> priority(boxes.size());
  const double mean = mean_bulk(boxes, executor);
  const double sum = sum_over(boxes, executor, [&](std::size_t i) {
    return priority[i] = bulk(boxes[i]) > mean ? splitter.priority(PrimId(i), boxes[i]) : 0;
  });

  // Deal out the cuts, rounded down; then cut.
  const double cuts_per_priority = sum > 0 ? double(share) * double(boxes.size()) / sum : 0;
  std::vector<Pieces> found(blocks);
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < block_end(block); ++i)
      splitter.split(PrimId(i), boxes[i], static_cast<std::size_t>(priority[i] * cuts_per_priority),
                     found[block]);
  });
  std::size_t count = 0;
  for (const Pieces& some : found) count += some.boxes.size();
  Pieces all;
  all.boxes.reserve(count);
  all.owners.reserve(count);
  for (Pieces& some : found) {
    all.boxes.insert(all.boxes.end(), some.boxes.begin(), some.boxes.end());
    all.owners.insert(all.owners.end(), some.owners.begin(), some.owners.end());
    some = {};
  }
  return all;
}

}  // namespace boxwood
