// item.h: what does a builder know about a primitive?
//
// Its box and its number, in 32 bytes that are cheap to grow by: a box is kept as (-lower, upper), so that a
// union is one maximum a lane, four lanes at a time, and the compiler needs no help to use vectors for it.
// Unions are exact and do not depend on the order of what they unite (a -0 becomes +0 at the door), which is
// why no tree depends on how its work was spread over threads.
#pragma once

#include <algorithm>
#include <bit>
#include <span>
#include <vector>

#include "boxwood/build/box_source.h"
#include "boxwood/core/box.h"
#include "boxwood/core/id.h"
#include "boxwood/core/lanes.h"
#include "boxwood/core/parallel.h"
#include "boxwood/core/raw_array.h"

namespace boxwood {

/// A box as (-lower, upper). Default: empty.
struct Reach {
  Lanes minus_lower = Lanes::all(-kInfinity);
  Lanes upper = Lanes::all(-kInfinity);

  void extend(const Reach& other) {
    minus_lower = max(minus_lower, other.minus_lower);
    upper = max(upper, other.upper);
  }
  void extend(Lanes point) {
    minus_lower = max(minus_lower, Lanes::all(0) - point);
    upper = max(upper, point);
  }
  float lower(int axis) const { return 0 - minus_lower.v[axis]; }
  Box3 box() const { return {{lower(0), lower(1), lower(2)}, {upper.v[0], upper.v[1], upper.v[2]}}; }
  /// As half_area(box()), without the way there; 0 for an empty box.
  double half_area() const {
    if (upper.v[0] == -kInfinity) return 0;
    const double x = double(upper.v[0]) + minus_lower.v[0], y = double(upper.v[1]) + minus_lower.v[1],
                 z = double(upper.v[2]) + minus_lower.v[2];
    return x * y + y * z + z * x;
  }
};

/// A primitive with a box that is finite and not empty.
struct Item {
  float minus_lower[3];
  PrimId prim_id;
  float upper[3];
  float unused = 0;

  Item() = default;
  Item(const Box3& box, PrimId id)
      : minus_lower{0 - box.lower.x, 0 - box.lower.y, 0 - box.lower.z},
        prim_id(id),
        upper{box.upper.x + 0.0f, box.upper.y + 0.0f, box.upper.z + 0.0f} {}

  Item(const Reach& reach, PrimId id, float rest) {
    *this = std::bit_cast<Item>(reach);
    prim_id = id;
    unused = rest;
  }

  Reach reach() const {
    // The number must not get into arithmetic:
    // as a float it is denormal, and each operation on it costs 150 cycles.
    const Reach with_number = std::bit_cast<Reach>(*this);
    return {with_number.minus_lower.with_fourth_zero(), with_number.upper.with_fourth_zero()};
  }
  /// *Half* of the center. Builders only compare centers, and the difference of two halves is finite for all
  /// boxes.
  float half_center(int axis) const { return 0.25f * upper[axis] - 0.25f * minus_lower[axis]; }
};
/// Twice the center; infinite where the box is at the end of the floats.
inline Lanes twice_center(const Reach& reach) {
  return reach.upper - reach.minus_lower;
}
inline Lanes half_center(const Reach& reach) {
  return Lanes::all(0.25f) * reach.upper - Lanes::all(0.25f) * reach.minus_lower;
}
static_assert(sizeof(Item) == 32 && sizeof(Reach) == 32);

/// The order along an axis: by center, equal centers by number. Total, so a sort has one result.
struct ByCenter {
  int axis;
  bool operator()(const Item& a, const Item& b) const {
    const float ca = a.half_center(axis), cb = b.half_center(axis);
    return ca != cb ? ca < cb : a.prim_id < b.prim_id;
  }
};

/// The union of boxes, and the range of twice their centers.
struct Bounds {
  Reach box, centers;
  void extend(const Bounds& other) {
    box.extend(other.box);
    centers.extend(other.centers);
  }
};

/// What there is to build over.
struct Items {
  RawArray<Item> full;              ///< Primitives with a box, in the order of their numbers.
  std::vector<PrimId> empty_boxes;  ///< Primitives that no box test will ever find.
  Bounds bounds;                    ///< Of the full ones.
};

/// Throws std::invalid_argument, naming it, when boxes[i] is neither finite nor the empty box.
void check_box(std::span<const Box3> boxes, std::size_t i);

/// Throws std::invalid_argument, naming the first one, when a box is neither finite nor the empty box.
Items collect_items(std::size_t count, const BoxSource& source, Executor& executor);

/// The union of `items`, and the union of their half centers.
struct Extents {
  Reach box, half_centers;
  void extend(const Item& item) {
    const Reach reach = item.reach();
    box.extend(reach);
    half_centers.extend(half_center(reach));
  }
  void extend(const Extents& other) {
    box.extend(other.box);
    half_centers.extend(other.half_centers);
  }
};
/// Areas of boxes inside one box, in floats: relative to the square of its longest side, so that they fit in
/// scenes of any size. A box without area counts by the length of its sides, a very little.
class Scale {
 public:
  explicit Scale(const Reach& box) {
    const Lanes extent = box.upper + box.minus_lower;
    const float longest = std::max(extent.v[0], std::max(extent.v[1], extent.v[2]));
    factor_ = Lanes::all(longest > 0x1p-120f ? 1 / longest : 0x1p120f);
  }
  /// What sums up to the half area: the areas of three sides. (inf, inf, inf) for an empty box.
  Lanes side_areas(const Reach& reach) const {
    const Lanes extent = (reach.upper + reach.minus_lower) * factor_;
    return extent * (extent.turned() + Lanes::all(0x1p-20f));
  }
  float factor() const { return factor_.v[0]; }
  float area(const Reach& reach) const {
    const Lanes sides = side_areas(reach);
    return sides.v[0] + sides.v[1] + sides.v[2];
  }

 private:
  Lanes factor_;
};

/// The axis along which `reach` is longest; halves are compared, so that nothing overflows.
inline int longest_axis(const Reach& reach) {
  const auto half_extent = [&](int k) { return 0.5f * reach.upper.v[k] + 0.5f * reach.minus_lower.v[k]; };
  return longest_axis(Vec3{half_extent(0), half_extent(1), half_extent(2)});
}

}  // namespace boxwood
