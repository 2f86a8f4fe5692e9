#include "boxwood/reference/kd_tree.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>

namespace boxwood::reference {
namespace {

// The prices of the surface area heuristic: a plane is three operations, a shape about fifty.
constexpr double kPlaneCost = 1, kShapeCost = 1.5;
// A cut that frees space costs this much of its price (Wald and Havran, section 3).
constexpr double kEmptyBonus = 0.8;
// The tree lists at most this many shapes for each one given;
// heaps of overlapping shapes would make it n^2 otherwise.
constexpr std::uint64_t kReferencesPerShape = 16;

/// One side of a box. A flat box has both its sides at one position.
struct Side {
  float position;
  std::uint32_t shape_index : 31, is_flat : 1;
};

/// The shapes of a cell: the lower and upper sides of their boxes on each axis, sorted by position.
struct CellLists {
  std::array<std::vector<Side>, 3> lower, upper;
  std::size_t size() const { return lower[0].size(); }
};

struct Cut {
  double cost = kInfinity;
  int axis = 0;
  float plane = 0;
  std::size_t lower_count = 0, upper_count = 0;
};

/// Where a shape goes at a cut, or does: both.
enum : std::uint8_t { kLower = 1, kUpper = 2 };

Box3 below(Box3 cell, int axis, float plane) {
  cell.upper[axis] = plane;
  return cell;
}
Box3 above(Box3 cell, int axis, float plane) {
  cell.lower[axis] = plane;
  return cell;
}

/// The cheapest plane strictly inside `cell`, of those through a side of a box. Cost +inf: there is none.
Cut find_cut(const CellLists& lists, const Box3& cell) {
  Cut best;
  const double area = half_area(cell);
  if (!(area > 0)) return best;

  const std::size_t n = lists.size();
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<Side>&lower = lists.lower[axis], &upper = lists.upper[axis];

    // Sweep both lists together, plane by plane.
    // Every box begins before it ends, so `upper` is the last to run out.
    std::size_t begun = 0, ended = 0;
    while (ended < n) {
      const float plane =
          begun < n ? min(lower[begun].position, upper[ended].position) : upper[ended].position;
      std::size_t lower_count = begun;  // those that begin before the plane, and those that lie in it
      for (; begun < n && lower[begun].position == plane; ++begun) lower_count += lower[begun].is_flat;
      while (ended < n && upper[ended].position == plane) ++ended;
      const std::size_t upper_count = n - ended;  // those that end behind it
      if (!(cell.lower[axis] < plane && plane < cell.upper[axis])) continue;

      // A ray that meets the cell meets a part of it with the
      // probability of their areas (MacDonald and Booth 1990).
      const double into_lower = half_area(below(cell, axis, plane)) / area;
      const double into_upper = half_area(above(cell, axis, plane)) / area;
      double cost =
          kPlaneCost + kShapeCost * (into_lower * double(lower_count) + into_upper * double(upper_count));
      if (lower_count == 0 || upper_count == 0) cost *= kEmptyBonus;
      if (cost < best.cost) best = {cost, axis, plane, lower_count, upper_count};
    }
  }
  return best;
}

}  // namespace

class KdTree::Builder {
 public:
  Builder(KdTree& tree, std::span<const Box3> boxes) : tree_(tree), where_(boxes.size()) {
    // Sort the sides of all boxes, once.
    CellLists lists;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i].is_empty()) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const bool is_flat = boxes[i].lower[axis] == boxes[i].upper[axis];
        lists.lower[axis].push_back({boxes[i].lower[axis], static_cast<std::uint32_t>(i), is_flat});
        lists.upper[axis].push_back({boxes[i].upper[axis], static_cast<std::uint32_t>(i), is_flat});
      }
    }
    const std::size_t n = lists.size();
    if (n == 0) return;
    const auto by_position = [](const Side& a, const Side& b) {
      return a.position != b.position ? a.position < b.position : a.shape_index < b.shape_index;
    };
    for (auto* sides : {&lists.lower, &lists.upper})
      for (std::vector<Side>& side : *sides) std::sort(side.begin(), side.end(), by_position);

    // A good depth is 8 + 1.3 log2 n (Havran, "Heuristic Ray Shooting Algorithms", 2000, section 4.5).
    max_depth_ = std::min(kMaxDepth - 1, 8 + static_cast<int>(1.3 * std::bit_width(n)));
    tree_.nodes_.emplace_back();
    fill(0, std::move(lists), tree_.bounds_, 0, kReferencesPerShape * n);
  }

 private:
  /// Makes node `node_index`, its children and theirs, which list at most `budget` shapes in all.
  void fill(std::uint32_t node_index, CellLists lists, const Box3& cell, int depth, std::uint64_t budget) {
    const std::size_t n = lists.size();
    const Cut cut = depth < max_depth_ ? find_cut(lists, cell) : Cut{};
    const std::uint64_t listed = cut.lower_count + cut.upper_count;
    if (!(cut.cost < kShapeCost * double(n)) || listed > budget) return make_leaf(node_index, lists);

    // Keep the lists sorted by handing each side on in its order.
    sort_out(lists, cut);
    CellLists lower, upper;
    for (int axis = 0; axis < 3; ++axis) {
      hand_on(lists.lower[axis], cut, lower.lower[axis], upper.lower[axis]);
      hand_on(lists.upper[axis], cut, lower.upper[axis], upper.upper[axis]);
    }
    lists = {};

    const auto first_child = static_cast<std::uint32_t>(tree_.nodes_.size());
    tree_.nodes_[node_index] = {cut.plane, first_child, static_cast<std::uint32_t>(cut.axis)};
    tree_.nodes_.resize(tree_.nodes_.size() + 2);
    const std::uint64_t lower_budget = budget * cut.lower_count / listed;
    fill(first_child, std::move(lower), below(cell, cut.axis, cut.plane), depth + 1, lower_budget);
    fill(first_child + 1, std::move(upper), above(cell, cut.axis, cut.plane), depth + 1,
         budget - lower_budget);
  }

  void make_leaf(std::uint32_t node_index, const CellLists& lists) {
    const auto first = static_cast<std::uint32_t>(tree_.prim_ids_.size());
    for (const Side& side : lists.lower[0]) tree_.prim_ids_.push_back(PrimId(side.shape_index));
    std::sort(tree_.prim_ids_.begin() + first, tree_.prim_ids_.end());
    tree_.nodes_[node_index] = {0, first, 3 + static_cast<std::uint32_t>(lists.size())};
  }

  /// Notes for each shape of `lists` on which side of the cut it stands.
  void sort_out(const CellLists& lists, const Cut& cut) {
    for (const Side& side : lists.lower[cut.axis])
      where_[side.shape_index] =
          side.position < cut.plane || (side.position == cut.plane && side.is_flat) ? kLower : 0;
    for (const Side& side : lists.upper[cut.axis])
      if (side.position > cut.plane) where_[side.shape_index] |= kUpper;
  }

  void hand_on(const std::vector<Side>& sides, const Cut& cut, std::vector<Side>& lower,
               std::vector<Side>& upper) const {
    lower.reserve(cut.lower_count);
    upper.reserve(cut.upper_count);
    for (const Side& side : sides) {
      if (where_[side.shape_index] & kLower) lower.push_back(side);
      if (where_[side.shape_index] & kUpper) upper.push_back(side);
    }
  }

  KdTree& tree_;
  std::vector<std::uint8_t> where_;
  int max_depth_ = 0;
};

KdTree::KdTree(std::span<const Box3> boxes) : bounds_(checked_bounds(boxes)) {
  if (boxes.size() > 0x7fffffff)
    throw std::invalid_argument("KdTree: " + std::to_string(boxes.size()) +
                                " boxes, expected fewer than 2^31");
  Builder(*this, boxes);
}

}  // namespace boxwood::reference
