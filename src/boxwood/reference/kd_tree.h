// kd_tree.h: what does a ray hit, when planes split space instead of boxes grouping shapes?
//
// A plane across one axis cuts a cell in two; each half lists every shape whose box reaches into it, so a
// shape may be listed, and tested, many times. In return the cells do not overlap and a node is one number.
// Planes are chosen by the surface area heuristic over all sides of all boxes in O(n log n) after Wald and
// Havran, "On building fast kd-Trees for Ray Tracing, and on doing that in O(N log N)", 2006, without their
// clipping of shapes to cells.
//
// Invariants: a cell lists each shape whose box reaches into it; a box that only touches the plane stands on
// its own side alone, and one that lies in the plane on the lower side. That is enough for the law of
// structure.h: the half-cells' intervals, widened as they are, overlap at the plane.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "boxwood/reference/structure.h"

namespace boxwood::reference {

class KdTree {
 public:
  static constexpr int kMaxDepth = 64;

  /// Shape i has boxes[i]; empty boxes are left out.
  /// Throws std::invalid_argument for a box that is not finite.
  explicit KdTree(std::span<const Box3> boxes);

  Box3 bounds() const { return bounds_; }
  std::size_t size_bytes() const { return nodes_.size() * sizeof(Node) + prim_ids_.size() * sizeof(PrimId); }

  /// Shapes listed, each as often as it is.
  std::size_t reference_count() const { return prim_ids_.size(); }

  template <Query Q, class Statistics>
  void walk(const PreparedRay& ray, Q& query, Statistics& statistics) const {
    struct Postponed {
      std::uint32_t node_index;
      float entry, exit;
    };
    Postponed stack[kMaxDepth];
    int waiting = 0;

    if (nodes_.empty()) return;
    statistics.count_boxes(1);
    const Interval whole = ray.interval(bounds_);
    Postponed cell{0, max(whole.entry, ray.t_min), whole.exit};
    if (!(cell.entry <= cell.exit)) return;

    while (true) {
      // Skip a cell that begins behind the best hit;
      // a hit beyond its own cell's exit stops nothing too early.
      if (cell.entry <= query.limit()) {
        const Node& node = nodes_[cell.node_index];
        if (!node.is_leaf()) {
          // The ray may be past the plane from `across.entry` on, and before it until `across.exit`.
          statistics.count_boxes(1);
          const Interval across = ray.slab(node.axis(), node.plane, node.plane);
          const std::uint32_t near_child = node.first_index + (ray.is_backward(node.axis()) ? 1 : 0);
          const std::uint32_t far_child = node.first_index + (ray.is_backward(node.axis()) ? 0 : 1);
          const Postponed near{near_child, cell.entry, min(cell.exit, across.exit)};
          const Postponed far{far_child, max(cell.entry, across.entry), cell.exit};
          const bool sees_far = far.entry <= far.exit;
          if (near.entry <= near.exit) {
            if (sees_far) stack[waiting++] = far;
            cell = near;
            continue;
          }
          if (sees_far) {
            cell = far;
            continue;
          }
        } else {
          for (std::uint32_t i = 0; i < node.count(); ++i)
            visit(query, prim_ids_[node.first_index + i], statistics);
        }
      }
      if (waiting == 0) return;
      cell = stack[--waiting];
    }
  }

 private:
  struct Node {
    float plane = 0;
    std::uint32_t first_index = 0;   // of the lower child, the upper one follows; or of the first shape
    std::uint32_t axis_or_leaf = 3;  // 0 to 2: the axis of the plane; otherwise 3 + the number of shapes

    bool is_leaf() const { return axis_or_leaf >= 3; }
    int axis() const { return static_cast<int>(axis_or_leaf); }
    std::uint32_t count() const { return axis_or_leaf - 3; }
  };

  class Builder;

  Box3 bounds_;
  std::vector<Node> nodes_;
  std::vector<PrimId> prim_ids_;
};

}  // namespace boxwood::reference
