#include "boxwood/reference/uniform_grid.h"

#include <algorithm>
#include <cmath>

namespace boxwood::reference {
namespace {

// Cells for each shape: more make shorter lists, but longer walks through nothing.
constexpr double kCellsPerShape = 4;
constexpr double kMaxResolution = 4096;
// The cells list at most this many shapes for each one given, or the cells get larger.
constexpr std::uint64_t kReferencesPerShape = 16;

/// Cells as near to cubes as whole numbers allow (Cleary and Wyvill, "Analysis of an algorithm for fast ray
/// tracing using uniform space subdivision", The Visual Computer 1988). An axis shorter than a cell is not
/// cut at all.
std::array<std::uint32_t, 3> cubic_resolution(const Box3& bounds, std::size_t shapes) {
  double extent[3];
  bool is_cut[3];
  for (int k = 0; k < 3; ++k) {
    extent[k] = double(bounds.upper[k]) - bounds.lower[k];
    is_cut[k] = extent[k] > 0;
  }
  double size = 0;
  for (bool again = true; again;) {
    // The logarithm of the cell's size, because the volume of a huge scene overflows.
    double log_volume = 0;
    int axes = 0;
    for (int k = 0; k < 3; ++k)
      if (is_cut[k]) log_volume += std::log(extent[k]), ++axes;
    if (axes == 0) return {1, 1, 1};
    size = std::exp((log_volume - std::log(kCellsPerShape * double(shapes))) / axes);
    again = false;
    for (int k = 0; k < 3; ++k)
      if (is_cut[k] && extent[k] < size) is_cut[k] = false, again = true;
  }
  std::array<std::uint32_t, 3> resolution{1, 1, 1};
  for (int k = 0; k < 3; ++k)
    if (is_cut[k])
      resolution[k] = static_cast<std::uint32_t>(std::clamp(extent[k] / size, 1.0, kMaxResolution));
  return resolution;
}

}  // namespace

struct UniformGrid::Block {
  std::uint32_t first[3], last[3];

  std::uint64_t size() const {
    std::uint64_t cells = 1;
    for (int k = 0; k < 3; ++k) cells *= last[k] - first[k] + 1;
    return cells;
  }
};

UniformGrid::UniformGrid(std::span<const Box3> boxes) : bounds_(checked_bounds(boxes)) {
  std::vector<PrimId> listed;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].is_empty()) listed.push_back(PrimId(i));
  if (listed.empty()) return;

  // Cut space, more coarsely each time that the cells would list too much. One cell lists everything once.
  const std::uint64_t budget = std::min<std::uint64_t>(kReferencesPerShape * listed.size(), 0xffffffffu);
  std::array<std::uint32_t, 3> resolution = cubic_resolution(bounds_, listed.size());
  for (std::uint64_t total = budget + 1; total > budget;) {
    cut(resolution);
    total = 0;
    for (const PrimId id : listed)
      if ((total += block_of(boxes[id.value]).size()) > budget) break;
    for (std::uint32_t& cells : resolution) cells = std::max(cells / 2, 1u);
  }

  // Count the shapes of each cell, turn the counts into ends,
  // and fill from the ends, so that each list is in order.
  const auto for_each_cell = [&](PrimId id, const auto& body) {
    const Block block = block_of(boxes[id.value]);
    for (std::uint32_t z = block.first[2]; z <= block.last[2]; ++z)
      for (std::uint32_t y = block.first[1]; y <= block.last[1]; ++y)
        for (std::uint32_t x = block.first[0]; x <= block.last[0]; ++x) body(cell_index(x, y, z));
  };
  first_.assign(std::size_t(resolution_[0]) * resolution_[1] * resolution_[2] + 1, 0);
  for (const PrimId id : listed) for_each_cell(id, [&](std::size_t cell) { ++first_[cell]; });
  std::uint32_t end = 0;
  for (std::uint32_t& first : first_) first = end += first;
  prim_ids_.resize(end);
  for (std::size_t i = listed.size(); i-- > 0;)
    for_each_cell(listed[i], [&](std::size_t cell) { prim_ids_[--first_[cell]] = listed[i]; });
}

std::size_t UniformGrid::size_bytes() const {
  std::size_t planes = 0;
  for (const std::vector<float>& axis : planes_) planes += axis.size();
  return planes * sizeof(float) + first_.size() * sizeof(std::uint32_t) + prim_ids_.size() * sizeof(PrimId);
}

void UniformGrid::cut(std::array<std::uint32_t, 3> resolution) {
  resolution_ = resolution;
  for (int k = 0; k < 3; ++k) {
    const double lower = bounds_.lower[k], extent = double(bounds_.upper[k]) - lower;
    planes_[k].resize(resolution[k] + 1);
    for (std::uint32_t i = 0; i < resolution[k]; ++i)
      planes_[k][i] = static_cast<float>(lower + extent * i / resolution[k]);
    planes_[k][resolution[k]] = bounds_.upper[k];
  }
}

std::uint32_t UniformGrid::cell_near(int axis, double position) const {
  const double extent = double(bounds_.upper[axis]) - bounds_.lower[axis];
  if (!(extent > 0)) return 0;
  const double cell = (position - bounds_.lower[axis]) / extent * resolution_[axis];
  return static_cast<std::uint32_t>(std::clamp(cell, 0.0, double(resolution_[axis] - 1)));
}

UniformGrid::Block UniformGrid::block_of(const Box3& box) const {
  Block block;
  for (int k = 0; k < 3; ++k) {
    const std::vector<float>& planes = planes_[k];

    // From the last cell that begins at or before the box...
    std::uint32_t first = cell_near(k, box.lower[k]);
    while (first > 0 && planes[first] > box.lower[k]) --first;
    while (first + 1 < resolution_[k] && planes[first + 1] <= box.lower[k]) ++first;

    // ... to the first that ends at or behind it.
    std::uint32_t last = std::max(cell_near(k, box.upper[k]), first);
    while (last > first && planes[last] >= box.upper[k]) --last;
    while (last + 1 < resolution_[k] && planes[last + 1] < box.upper[k]) ++last;
    block.first[k] = first;
    block.last[k] = last;
  }
  return block;
}

}  // namespace boxwood::reference
