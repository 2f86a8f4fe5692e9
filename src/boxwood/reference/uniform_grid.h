// uniform_grid.h: what does a ray hit, when space is cut into equal cells without any tree?
//
// The walk is the 3D-DDA of Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing",
// Eurographics 1987: of the next planes on x, y and z, step over the nearest. Theirs stands in one cell at a
// time, and near an edge rounding may put it into the wrong one. Ours knows for each axis the row of cells
// that the ray may be in (their widened intervals overlap), from `rear` to `front`: nearly always one, two at
// a plane, all when the ray runs inside a plane. A step moves one front and looks at the new cell, combined
// with the rows of the other axes. So each cell with a nonempty interval is visited once, in the order of
// entry.
//
// Invariants: a cell lists each shape whose box reaches into it, by the rule of kd_tree.h; the planes of an
// axis never decrease, and the first and the last are those of the bounds.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "boxwood/reference/structure.h"

namespace boxwood::reference {

class UniformGrid {
 public:
  /// Shape i has boxes[i]; empty boxes are left out.
  /// Throws std::invalid_argument for a box that is not finite.
  explicit UniformGrid(std::span<const Box3> boxes);

  Box3 bounds() const { return bounds_; }
  std::size_t size_bytes() const;

  /// Shapes listed, each as often as it is.
  std::size_t reference_count() const { return prim_ids_.size(); }
  std::array<std::uint32_t, 3> resolution() const { return resolution_; }

  template <Query Q, class Statistics>
  void walk(const PreparedRay& ray, Q& query, Statistics& statistics) const {
    if (prim_ids_.empty()) return;
    statistics.count_boxes(1);
    const Interval whole = ray.interval(bounds_);
    const float start = max(whole.entry, ray.t_min);
    if (!(start <= whole.exit)) return;

    // Cells are counted in the direction of the ray from here on.
    struct Row {
      int rear, front, count;
      float next;  // where the ray may enter the cell after `front`
    } rows[3];
    const auto index = [&](int k, int cell) { return ray.is_backward(k) ? rows[k].count - 1 - cell : cell; };
    const auto across = [&](int k, int cell) {
      const int i = index(k, cell);
      return ray.slab(k, planes_[k][i], planes_[k][i + 1]);
    };
    const auto next = [&](int k) {
      return rows[k].front + 1 < rows[k].count ? across(k, rows[k].front + 1).entry : kInfinity;
    };

    // Find the rows where the ray starts: near the point, then exactly.
    for (int k = 0; k < 3; ++k) {
      rows[k].count = static_cast<int>(resolution_[k]);
      const double position = ray.origin[k] + double(start) * ray.direction[k];
      Row& row = rows[k];
      row.rear = row.front = index(k, static_cast<int>(cell_near(k, position)));
      while (row.front + 1 < row.count && across(k, row.front + 1).entry <= start) ++row.front;
      while (row.front > 0 && across(k, row.front).entry > start) --row.front;
      while (row.rear > 0 && across(k, row.rear - 1).exit >= start) --row.rear;
      while (row.rear < row.front && across(k, row.rear).exit < start) ++row.rear;
      row.next = next(k);
    }

    const auto look = [&](int x_first, int y_first, int z_first) {
      for (int z = z_first; z <= rows[2].front; ++z)
        for (int y = y_first; y <= rows[1].front; ++y)
          for (int x = x_first; x <= rows[0].front; ++x) {
            statistics.count_boxes(1);
            const std::size_t cell = cell_index(index(0, x), index(1, y), index(2, z));
            for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i)
              visit(query, prim_ids_[i], statistics);
          }
    };
    look(rows[0].rear, rows[1].rear, rows[2].rear);

    while (true) {
      // Step over the nearest plane. All cells not seen yet begin behind it.
      const int k = rows[0].next <= rows[1].next ? (rows[0].next <= rows[2].next ? 0 : 2)
                                                 : (rows[1].next <= rows[2].next ? 1 : 2);
      const float now = rows[k].next;
      if (!(now <= whole.exit && now <= query.limit()) || now == kInfinity) return;
      ++rows[k].front;
      rows[k].next = next(k);

      // Leave the cells that end before it.
      for (int m = 0; m < 3; ++m)
        while (rows[m].rear < rows[m].front && across(m, rows[m].rear).exit < now) ++rows[m].rear;
      look(k == 0 ? rows[0].front : rows[0].rear, k == 1 ? rows[1].front : rows[1].rear,
           k == 2 ? rows[2].front : rows[2].rear);
    }
  }

 private:
  struct Block;  // of cells, first and last on each axis

  std::size_t cell_index(std::size_t x, std::size_t y, std::size_t z) const {
    return (z * resolution_[1] + y) * resolution_[0] + x;
  }
  /// The cell that holds `position` on `axis`, or one near it; the nearest end outside.
  std::uint32_t cell_near(int axis, double position) const;
  Block block_of(const Box3& box) const;
  void cut(std::array<std::uint32_t, 3> resolution);

  Box3 bounds_;
  std::array<std::uint32_t, 3> resolution_{1, 1, 1};
  std::array<std::vector<float>, 3> planes_;  // resolution + 1 of them on each axis
  std::vector<std::uint32_t> first_;          // for each cell its first shape in prim_ids_, and the end
  std::vector<PrimId> prim_ids_;
};

}  // namespace boxwood::reference
