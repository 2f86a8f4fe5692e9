#include "boxwood/reference/octree.h"

#include <algorithm>
#include <array>

namespace boxwood::reference {
namespace {

// A cell with this many shapes or fewer is not cut.
constexpr std::size_t kLeafSize = 8;
// The tree lists at most this many shapes for each one given;
// heaps of overlapping shapes would make it n^2 otherwise.
constexpr std::uint64_t kReferencesPerShape = 16;

/// Whether `box` is listed in the half of a cell above (or below) `plane`,
/// given that it reaches into the cell.
bool is_above(const Box3& box, int axis, float plane) {
  return box.upper[axis] > plane;
}
bool is_below(const Box3& box, int axis, float plane) {
  return box.lower[axis] < plane || (box.lower[axis] == plane && box.upper[axis] == plane);
}

Box3 octant_of(const Box3& cell, Vec3 center, unsigned octant) {
  Box3 part = cell;
  for (int k = 0; k < 3; ++k) (octant >> k & 1 ? part.lower : part.upper)[k] = center[k];
  return part;
}

}  // namespace

class Octree::Builder {
 public:
  Builder(Octree& tree, std::span<const Box3> boxes) : tree_(tree), boxes_(boxes) {
    std::vector<PrimId> all;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      if (!boxes[i].is_empty()) all.push_back(PrimId(i));
    if (all.empty()) return;
    const std::uint64_t budget = kReferencesPerShape * all.size();
    tree_.nodes_.emplace_back();
    fill(0, std::move(all), tree_.bounds_, 0, budget);
  }

 private:
  /// Makes node `node_index`, its octants and theirs, which list at most `budget` shapes in all.
  void fill(std::uint32_t node_index, std::vector<PrimId> listed, const Box3& cell, int depth,
            std::uint64_t budget) {
    if (listed.size() <= kLeafSize || depth >= kMaxDepth) return make_leaf(node_index, listed);

    // List each shape in every octant that its box reaches into.
    const Vec3 center = cell.center();
    std::array<std::vector<PrimId>, 8> parts;
    for (const PrimId id : listed) {
      const Box3& box = boxes_[id.value];
      for (unsigned octant = 0; octant < 8; ++octant) {
        bool reaches = true;
        for (int k = 0; k < 3; ++k)
          reaches = reaches && (octant >> k & 1 ? is_above(box, k, center[k]) : is_below(box, k, center[k]));
        if (reaches) parts[octant].push_back(id);
      }
    }

    // A cut must be affordable, and must not give every shape to several octants.
    std::uint64_t total = 0;
    std::size_t smallest = listed.size();
    unsigned octants = 0;
    for (unsigned octant = 0; octant < 8; ++octant) {
      if (parts[octant].empty()) continue;
      octants |= 1u << octant;
      total += parts[octant].size();
      smallest = std::min(smallest, parts[octant].size());
    }
    const bool is_vain = std::popcount(octants) > 1 && smallest == listed.size();
    if (total > budget || is_vain) return make_leaf(node_index, listed);
    listed = {};

    auto child = static_cast<std::uint32_t>(tree_.nodes_.size());
    tree_.nodes_[node_index] = {center, child, 0, octants};
    tree_.nodes_.resize(tree_.nodes_.size() + static_cast<std::size_t>(std::popcount(octants)));

    // Share what may still be listed in proportion.
    for (unsigned octant = 0; octant < 8; ++octant) {
      if (parts[octant].empty()) continue;
      const std::uint64_t share = budget * parts[octant].size() / total;
      fill(child++, std::move(parts[octant]), octant_of(cell, center, octant), depth + 1, share);
    }
  }

  void make_leaf(std::uint32_t node_index, const std::vector<PrimId>& listed) {
    const auto first = static_cast<std::uint32_t>(tree_.prim_ids_.size());
    tree_.nodes_[node_index] = {{}, first, static_cast<std::uint32_t>(listed.size()), 0};
    tree_.prim_ids_.insert(tree_.prim_ids_.end(), listed.begin(), listed.end());
  }

  Octree& tree_;
  std::span<const Box3> boxes_;
};

Octree::Octree(std::span<const Box3> boxes) : bounds_(checked_bounds(boxes)) {
  Builder(*this, boxes);
}

}  // namespace boxwood::reference
