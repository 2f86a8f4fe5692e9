#include "boxwood/build/ploc.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace boxwood {
namespace {

/// Clusters of a chunk, and how many may be left of it for the next phase.
constexpr std::uint32_t kChunk = 1024, kEnough = 64;

/// Subtrees of fewer primitives are written by one thread.
constexpr std::uint32_t kTaskSize = 4096;

}  // namespace

/// The clusters of one chunk, side by side.
class PlocBuilder::Row {
 public:
  Row() : planes_(6 * kStride) {
    for (int k = 0; k < 6; ++k) {
      boxes.plane[k] = planes_.data() + k * kStride + kReach;
      std::fill_n(boxes.plane[k] - kReach, kReach, 3e38f);
    }
  }
  /// Ends the row behind `count` clusters.
  void close(std::uint32_t count) {
    boxes.count = count;
    for (float* plane : boxes.plane) std::fill_n(plane + count, 2 * kReach, 3e38f);
  }
  Reach reach(std::uint32_t i) const {
    const auto& p = boxes.plane;
    return {{Lanes::Register{p[0][i], p[1][i], p[2][i], 0}}, {Lanes::Register{p[3][i], p[4][i], p[5][i], 0}}};
  }
  void set(std::uint32_t i, std::uint32_t which, std::uint32_t primitives, float price, const Reach& reach) {
    for (int k = 0; k < 3; ++k) {
      boxes.plane[k][i] = reach.minus_lower.v[k];
      boxes.plane[k + 3][i] = reach.upper.v[k];
    }
    cluster[i] = which;
    count[i] = primitives;
    cost[i] = price;
  }
  void move(std::uint32_t from, std::uint32_t to) {
    for (float* plane : boxes.plane) plane[to] = plane[from];
    cluster[to] = cluster[from];
    count[to] = count[from];
    cost[to] = cost[from];
  }

  BoxRow boxes;
  std::uint32_t cluster[kChunk];
  std::uint32_t count[kChunk];  ///< Primitives.
  float cost[kChunk];           ///< SAH, areas as in Scale; of use where there are few primitives.
  std::uint16_t partner[kChunk];

 private:
  static constexpr std::size_t kStride = kChunk + 3 * kReach;
  RawArray<float> planes_;
};

PlocBuilder::PlocBuilder(const Items& items, const BuildOptions& options, Executor& executor, Meter& meter)
    : leaf_size_(static_cast<std::uint32_t>(options.leaf_size)),
      max_depth_(options.max_depth),
      cost_{options.traversal_cost, static_cast<std::uint32_t>(options.block_size)},
      scale_(items.bounds.box) {
  if (items.full.size() == 0) return;
  order_ = in_morton_order({items.full.data(), items.full.size()}, items.bounds.centers,
                           std::min(leaf_size_, std::min(cost_.block, 8u)), Keep::ids, executor);
  merge_all(executor, meter);
}

void PlocBuilder::merge_all(Executor& executor, Meter& meter) {
  // As many pairs as all phases can make: each chunk at most one less than it has clusters.
  const auto groups = static_cast<std::uint32_t>(order_.groups.size());
  const auto chunks_of = [](std::size_t clusters) { return (clusters + kChunk - 1) / kChunk; };
  std::size_t most = groups;
  for (std::size_t clusters = groups; clusters > kChunk; most += clusters)
    clusters = chunks_of(clusters) * kEnough;
  pairs_ = RawArray<Pair>(most);

  RawArray<std::uint32_t> clusters(groups);
  std::iota(clusters.begin(), clusters.end(), static_cast<std::uint32_t>(most));
  std::size_t count = groups, first_pair = 0;
  while (count > 1) {
    meter.advance(0);
    const std::size_t chunks = chunks_of(count);
    std::vector<std::uint32_t> left(chunks);
    parallel_for(executor, 0, chunks, 1, [&](std::size_t chunk) {
      const std::size_t begin = chunk * kChunk;
      Row row;
      fill(row, &clusters[begin], static_cast<std::uint32_t>(std::min<std::size_t>(kChunk, count - begin)));
      merge_chunk(row, chunks == 1 ? 1 : kEnough, static_cast<std::uint32_t>(first_pair + begin));
      std::copy_n(row.cluster, row.boxes.count, &clusters[begin]);
      left[chunk] = row.boxes.count;
    });

    // What is left moves together.
    first_pair += count;
    count = left[0];
    for (std::size_t chunk = 1; chunk < chunks; ++chunk) {
      std::copy_n(&clusters[chunk * kChunk], left[chunk], &clusters[count]);
      count += left[chunk];
    }
  }
  root_ = clusters[0];
}

void PlocBuilder::fill(Row& row, const std::uint32_t* clusters, std::uint32_t count) const {
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t c = clusters[i];
    if (is_group(c)) {
      const Reach reach = group(c).reach();
      const std::uint32_t primitives = size_of(group(c));
      row.set(i, c, primitives, static_cast<float>(cost_.leaf(scale_.area(reach), primitives)), reach);
    } else {
      const Box3& box = pairs_[c].box;
      const Reach reach{{Lanes::Register{-box.lower.x, -box.lower.y, -box.lower.z, 0}},
                        {Lanes::Register{box.upper.x, box.upper.y, box.upper.z, 0}}};
      row.set(i, c, pairs_[c].count, pairs_[c].cost, reach);
    }
  }
  row.close(count);
}

void PlocBuilder::merge_chunk(Row& row, std::uint32_t enough, std::uint32_t first_pair) {
  std::uint32_t next_pair = first_pair;
  while (row.boxes.count > enough) {
    const std::uint32_t count = row.boxes.count;
    find_nearest(row.boxes, scale_, row.partner);

    // Where hardly anybody is chosen by the one it chose, merge everybody with the next.
    std::uint32_t mutual = 0;
    for (std::uint32_t i = 0; i < count; ++i) mutual += row.partner[row.partner[i]] == i;
    if (mutual < count / 16)
      for (std::uint32_t i = 0; i < count; ++i)
        row.partner[i] = static_cast<std::uint16_t>((i ^ 1) < count ? i ^ 1 : i - 1);

    // Merge in place: what is written lies before what is still to be read.
    std::uint32_t end = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t j = row.partner[i];
      if (row.partner[j] != i) {
        row.move(i, end++);
        continue;
      }
      if (j < i) continue;
      Reach both = row.reach(i);
      both.extend(row.reach(j));
      const std::uint32_t primitives = row.count[i] + row.count[j];
      Pair& pair = pairs_[next_pair];
      const std::uint32_t left = row.cluster[i], right = row.cluster[j];
      pair.box = both.box();
      pair.left = left;
      pair.right = right;
      pair.count = primitives;
      pair.cost = 0;
      pair.kind = Pair::Kind::pair;
      if (primitives <= leaf_size_) {
        const double area = scale_.area(both);
        const double as_leaf = cost_.leaf(area, primitives);
        const double as_pair = cost_.split(area, double(row.cost[i]) + row.cost[j]);
        if (as_leaf <= as_pair) pair.kind = Pair::Kind::leaf;
        pair.cost = static_cast<float>(std::min(as_leaf, as_pair));
      }
      const bool is_leaf = pair.kind == Pair::Kind::leaf;
      pair.nodes_below = is_leaf ? 0 : 2 + nodes_below(left) + nodes_below(right);
      pair.height = static_cast<std::uint8_t>(
          is_leaf ? 0 : std::min(1 + std::max(height_of(left), height_of(right)), 255));
      row.set(end++, next_pair++, primitives, pair.cost, both);
    }
    row.close(end);
  }
}

RawBvh PlocBuilder::tree(std::span<const PrimId> empty_boxes, const BoxSource& source, Executor& executor,
                         Meter& meter) {
  const auto full = static_cast<std::uint32_t>(order_.ids.size());
  const auto empty = static_cast<std::uint32_t>(empty_boxes.size());
  RawBvh bvh;
  if (full + empty == 0) return bvh;
  bvh.prim_ids = RawArray<PrimId>(std::size_t(full) + empty);
  std::copy(empty_boxes.begin(), empty_boxes.end(), bvh.prim_ids.begin() + full);

  // One kind of primitives: they are the tree.
  const auto count_full = [&](int levels) {
    if (height_of(root_) > levels) keep_within(root_, levels);
    return nodes_below(root_);
  };
  if (full == 0) {
    bvh.nodes = RawArray<BvhNode>(1 + nodes_below_halved(empty, max_depth_));
    write_halved(bvh, empty, {0, 1, 0}, max_depth_, nullptr);
    return bvh;
  }
  if (empty == 0) {
    bvh.nodes = RawArray<BvhNode>(1 + std::size_t(count_full(max_depth_)));
    write(bvh, root_, {0, 1, 0}, max_depth_, source, executor, meter);
    return bvh;
  }

  // Both: side by side.
  const Box3 box = is_group(root_) ? group(root_).reach().box() : pairs_[root_].box;
  if (max_depth_ == 0) {
    bvh.nodes = RawArray<BvhNode>(1);
    bvh.nodes[0] = {box, 0, full + empty};
    write_members(root_, bvh.prim_ids.data());
    return bvh;
  }
  const std::uint32_t below = count_full(max_depth_ - 1);
  bvh.nodes = RawArray<BvhNode>(3 + std::size_t(below) + nodes_below_halved(empty, max_depth_ - 1));
  bvh.nodes[0] = {box, 1, 0};
  write(bvh, root_, {1, 3, 0}, max_depth_ - 1, source, executor, meter);
  write_halved(bvh, empty, {2, 3 + below, full}, max_depth_ - 1, nullptr);
  return bvh;
}

void PlocBuilder::keep_within(std::uint32_t cluster, int levels) {
  if (height_of(cluster) <= levels) return;
  Pair& pair = pairs_[cluster];
  const std::uint32_t leaves = (pair.count - 1) / leaf_size_ + 1;
  if (levels <= static_cast<int>(std::bit_width(leaves - 1))) {
    pair.kind = Pair::Kind::halved;
    pair.nodes_below = nodes_below_halved(pair.count, levels);
    return;
  }
  keep_within(pair.left, levels - 1);
  keep_within(pair.right, levels - 1);
  pair.nodes_below = 2 + nodes_below(pair.left) + nodes_below(pair.right);
}

std::uint32_t PlocBuilder::nodes_below_halved(std::uint32_t count, int levels) const {
  if (levels == 0 || count <= leaf_size_) return 0;
  return 2 + nodes_below_halved(count / 2, levels - 1) + nodes_below_halved(count - count / 2, levels - 1);
}

void PlocBuilder::write(RawBvh& bvh, std::uint32_t cluster, Slot slot, int levels, const BoxSource& source,
                        Executor& executor, Meter& meter) const {
  const std::uint32_t count = count_of(cluster);
  if (count <= kTaskSize || pairs_[cluster].kind != Pair::Kind::pair) {
    write_small(bvh, cluster, slot, levels, source);
    return meter.advance(count);
  }
  meter.advance(0);
  const Pair& pair = pairs_[cluster];
  bvh.nodes[slot.node_index] = {pair.box, slot.base, 0};
  const Slot left{slot.base, slot.base + 2, slot.first_prim};
  const Slot right{slot.base + 1, left.base + nodes_below(pair.left), slot.first_prim + count_of(pair.left)};
  executor.both([&] { write(bvh, pair.left, left, levels - 1, source, executor, meter); },
                [&] { write(bvh, pair.right, right, levels - 1, source, executor, meter); });
}

void PlocBuilder::write_small(RawBvh& bvh, std::uint32_t cluster, Slot slot, int levels,
                              const BoxSource& source) const {
  BvhNode& node = bvh.nodes[slot.node_index];
  PrimId* const ids = &bvh.prim_ids[slot.first_prim];
  if (is_group(cluster)) {
    const Group& leaf = group(cluster);
    node = {leaf.reach().box(), slot.first_prim, size_of(leaf)};
    std::copy_n(order_.ids.data() + first_of(leaf), size_of(leaf), ids);
    return;
  }
  const Pair& pair = pairs_[cluster];
  if (pair.kind != Pair::Kind::pair) {
    write_members(cluster, ids);
    if (pair.kind == Pair::Kind::halved)
      write_halved(bvh, pair.count, slot, levels, source);
    else
      node = {pair.box, slot.first_prim, pair.count};
    return;
  }
  node = {pair.box, slot.base, 0};
  write_small(bvh, pair.left, {slot.base, slot.base + 2, slot.first_prim}, levels - 1, source);
  write_small(bvh, pair.right,
              {slot.base + 1, slot.base + 2 + nodes_below(pair.left), slot.first_prim + count_of(pair.left)},
              levels - 1, source);
}

Box3 PlocBuilder::write_halved(RawBvh& bvh, std::uint32_t count, Slot slot, int levels,
                               const BoxSource& source) const {
  BvhNode& node = bvh.nodes[slot.node_index];
  if (levels == 0 || count <= leaf_size_) {
    Box3 box;
    if (source)
      for (std::uint32_t i = 0; i < count; ++i) {
        Box3 own;
        const std::size_t prim = bvh.prim_ids[slot.first_prim + i].value;
        source(prim, prim + 1, &own);
        box.extend(own);
      }
    node = {box, slot.first_prim, count};
    return box;
  }
  const std::uint32_t half = count / 2;
  Box3 box = write_halved(bvh, half, {slot.base, slot.base + 2, slot.first_prim}, levels - 1, source);
  box.extend(write_halved(
      bvh, count - half,
      {slot.base + 1, slot.base + 2 + nodes_below_halved(half, levels - 1), slot.first_prim + half},
      levels - 1, source));
  node = {box, slot.base, 0};
  return box;
}

PrimId* PlocBuilder::write_members(std::uint32_t cluster, PrimId* out) const {
  if (is_group(cluster)) {
    const PrimId* first = order_.ids.data() + first_of(group(cluster));
    return std::copy(first, first + size_of(group(cluster)), out);
  }
  return write_members(pairs_[cluster].right, write_members(pairs_[cluster].left, out));
}

}  // namespace boxwood
