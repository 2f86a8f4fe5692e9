// octree.h: what does a ray hit, when each cell of space is cut into eight equal ones?
//
// Glassner, "Space Subdivision for Fast Ray Tracing", IEEE CG&A 1984. Nothing is optimized and nothing has to
// be decided: a crowded cell is cut through its center. A shape is listed in every cell that its box reaches
// into, and tested in each. The walk keeps the ray's interval across each axis; the middle plane makes two of
// each, and an octant's interval is what three of these share. Octants are met in the order of their number,
// counted in the ray's direction.
//
// Invariants: as in kd_tree.h. Only octants that list something exist; a node's own stand side by side.
#pragma once

#include <bit>
#include <span>
#include <vector>

#include "boxwood/reference/structure.h"

namespace boxwood::reference {

class Octree {
 public:
  static constexpr int kMaxDepth = 20;

  /// Shape i has boxes[i]; empty boxes are left out.
  /// Throws std::invalid_argument for a box that is not finite.
  explicit Octree(std::span<const Box3> boxes);

  Box3 bounds() const { return bounds_; }
  std::size_t size_bytes() const { return nodes_.size() * sizeof(Node) + prim_ids_.size() * sizeof(PrimId); }

  /// Shapes listed, each as often as it is.
  std::size_t reference_count() const { return prim_ids_.size(); }

  template <Query Q, class Statistics>
  void walk(const PreparedRay& ray, Q& query, Statistics& statistics) const {
    struct Postponed {
      std::uint32_t node_index;
      Interval across[3];
      float entry;
    };
    Postponed stack[7 * kMaxDepth + 8];
    int waiting = 0;

    // The root's interval, axis by axis.
    if (nodes_.empty()) return;
    statistics.count_boxes(1);
    Postponed root{0, {}, ray.bound(bounds_)};
    for (int k = 0; k < 3; ++k) root.across[k] = ray.slab(k, bounds_.lower[k], bounds_.upper[k]);
    if (root.entry < kInfinity) stack[waiting++] = root;
    const unsigned backward =
        (ray.is_backward(0) ? 1u : 0) | (ray.is_backward(1) ? 2u : 0) | (ray.is_backward(2) ? 4u : 0);

    while (waiting > 0) {
      const Postponed cell = stack[--waiting];
      if (!(cell.entry <= query.limit())) continue;
      const Node& node = nodes_[cell.node_index];
      if (node.is_leaf()) {
        for (std::uint32_t i = 0; i < node.count; ++i)
          visit(query, prim_ids_[node.first_index + i], statistics);
        continue;
      }

      // Halve the interval of each axis: [0] before the middle plane, [1] behind it, as the ray runs.
      Interval half[3][2];
      for (int k = 0; k < 3; ++k) {
        const Interval plane = ray.slab(k, node.center[k], node.center[k]);
        half[k][0] = {cell.across[k].entry, min(cell.across[k].exit, plane.exit)};
        half[k][1] = {max(cell.across[k].entry, plane.entry), cell.across[k].exit};
      }

      // Put the octants on the stack from the last to the first.
      statistics.count_boxes(std::popcount(node.octants));
      for (unsigned step = 8; step-- > 0;) {
        const unsigned octant = step ^ backward;
        if (!(node.octants >> octant & 1)) continue;
        const Interval &x = half[0][step & 1], &y = half[1][step >> 1 & 1], &z = half[2][step >> 2];
        const float entry = max(max(x.entry, y.entry), max(z.entry, ray.t_min));
        if (!(entry <= min(x.exit, min(y.exit, z.exit)))) continue;
        const int before = std::popcount(node.octants & ((1u << octant) - 1));
        stack[waiting++] = {node.first_index + static_cast<std::uint32_t>(before), {x, y, z}, entry};
      }
    }
  }

 private:
  struct Node {
    Vec3 center;                    // where the cell is cut
    std::uint32_t first_index = 0;  // of the first octant, or of the first shape
    std::uint32_t count = 0;        // shapes of a leaf
    unsigned octants = 0;  // bit k: octant k exists; none: a leaf. Bits of k: above the center on x, y, z

    bool is_leaf() const { return octants == 0; }
  };

  class Builder;

  Box3 bounds_;
  std::vector<Node> nodes_;
  std::vector<PrimId> prim_ids_;
};

}  // namespace boxwood::reference
