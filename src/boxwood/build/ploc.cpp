#include "boxwood/build/ploc.h"

#include <algorithm>
#include <numeric>

namespace boxwood {
namespace {

/// Clusters of a chunk, and how many may be left of it for the next phase.
constexpr std::uint32_t kChunk = 1024, kEnough = 64;

/// Subtrees of fewer primitives are written by one thread.
constexpr std::uint32_t kTaskSize = 4096;

}  // namespace

/// The clusters of one chunk, side by side.
class PlocSplitter::Row {
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

PlocSplitter::PlocSplitter(const Items& items, const BuildOptions& options, Executor& executor, Meter& meter)
    : items_(items),
      leaf_size_(static_cast<std::uint32_t>(options.leaf_size)),
      cost_{options.traversal_cost, static_cast<std::uint32_t>(options.block_size)},
      scale_(items.bounds.box),
      list_(items.full.size()) {
  if (items.full.size() == 0) return;
  order_ = in_morton_order({items.full.data(), items.full.size()}, items.bounds.centers,
                           std::min(leaf_size_, std::min(cost_.block, 8u)), Keep::ids, executor);
  merge_all(executor, meter);
}

void PlocSplitter::merge_all(Executor& executor, Meter& meter) {
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

void PlocSplitter::fill(Row& row, const std::uint32_t* clusters, std::uint32_t count) const {
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

void PlocSplitter::merge_chunk(Row& row, std::uint32_t enough, std::uint32_t first_pair) {
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
      pair.is_leaf = false;
      if (primitives <= leaf_size_) {
        const double area = scale_.area(both);
        const double as_leaf = cost_.leaf(area, primitives);
        const double as_pair = cost_.split(area, double(row.cost[i]) + row.cost[j]);
        pair.is_leaf = as_leaf <= as_pair;
        pair.cost = static_cast<float>(std::min(as_leaf, as_pair));
      }
      pair.nodes_below = pair.is_leaf ? 0 : 2 + nodes_below(left) + nodes_below(right);
      pair.height = static_cast<std::uint8_t>(
          pair.is_leaf ? 0 : std::min(1 + std::max(height_of(left), height_of(right)), 255));
      row.set(end++, next_pair++, primitives, pair.cost, both);
    }
    row.close(end);
  }
}

RawBvh PlocSplitter::tree(Executor& executor, Meter& meter) const {
  RawBvh bvh{RawArray<BvhNode>(1 + std::size_t(nodes_below(root_))), RawArray<PrimId>(items_.full.size())};
  write_subtree(bvh, 0, root_, {1, 0}, executor, meter);
  return bvh;
}

void PlocSplitter::write_subtree(RawBvh& bvh, std::uint32_t node_index, std::uint32_t cluster, Slot slot,
                                 Executor& executor, Meter& meter) const {
  const std::uint32_t count = count_of(cluster);
  if (count <= kTaskSize || is_group(cluster) || pairs_[cluster].is_leaf) {
    write_small(bvh, node_index, cluster, slot);
    return meter.advance(count);
  }
  meter.advance(0);
  const std::uint32_t left = pairs_[cluster].left, right = pairs_[cluster].right;
  bvh.nodes[node_index] = {pairs_[cluster].box, slot.base, 0};
  const Slot to_left{slot.base + 2, slot.first_prim};
  const Slot to_right{to_left.base + nodes_below(left), slot.first_prim + count_of(left)};
  executor.both([&] { write_subtree(bvh, slot.base, left, to_left, executor, meter); },
                [&] { write_subtree(bvh, slot.base + 1, right, to_right, executor, meter); });
}

void PlocSplitter::write_small(RawBvh& bvh, std::uint32_t node_index, std::uint32_t cluster,
                               Slot slot) const {
  if (is_group(cluster)) {
    const Group& leaf = group(cluster);
    bvh.nodes[node_index] = {leaf.reach().box(), slot.first_prim, size_of(leaf)};
    std::copy_n(order_.ids.data() + first_of(leaf), size_of(leaf), &bvh.prim_ids[slot.first_prim]);
    return;
  }
  const Pair& pair = pairs_[cluster];
  if (pair.is_leaf) {
    bvh.nodes[node_index] = {pair.box, slot.first_prim, pair.count};
    write_members(cluster, &bvh.prim_ids[slot.first_prim]);
    return;
  }
  bvh.nodes[node_index] = {pair.box, slot.base, 0};
  write_small(bvh, slot.base, pair.left, {slot.base + 2, slot.first_prim});
  write_small(bvh, slot.base + 1, pair.right,
              {slot.base + 2 + nodes_below(pair.left), slot.first_prim + count_of(pair.left)});
}

Step<PlocSplitter::Share> PlocSplitter::step(Range range, Plan plan, const Share& share) {
  PrimId* const list = list_.data() + range.begin;
  const std::uint32_t count = range.size();
  if (!share.is_list) {
    const bool has_parts = !is_group(share.cluster);
    const Box3 box = has_parts ? pairs_[share.cluster].box : group(share.cluster).reach().box();
    if (plan == Plan::leaf || !has_parts || (plan == Plan::choose && pairs_[share.cluster].is_leaf))
      return {box, range.begin, share, share};
    if (plan == Plan::choose) {
      const Pair& pair = pairs_[share.cluster];
      return {box, range.begin + count_of(pair.left), {pair.left}, {pair.right}};
    }
    write_members(share.cluster, list);
  }
  const Share part{share.cluster, true};
  const bool is_leaf = plan == Plan::leaf || (plan == Plan::choose && count <= leaf_size_);
  return {box_of({list, count}), range.begin + (is_leaf ? 0 : count / 2), part, part};
}

Box3 PlocSplitter::box_of(std::span<const PrimId> ids) const {
  Box3 box;
  for (const PrimId id : ids) {
    // Items lie in the order of their numbers, with gaps where boxes are empty.
    const Item* item = items_.full.data() + id.value;
    if (!items_.empty_boxes.empty())
      item = std::lower_bound(items_.full.begin(), items_.full.end(), id,
                              [](const Item& a, PrimId b) { return a.prim_id < b; });
    box.extend(item->reach().box());
  }
  return box;
}

PrimId* PlocSplitter::write_members(std::uint32_t cluster, PrimId* out) const {
  if (is_group(cluster)) {
    const PrimId* first = order_.ids.data() + first_of(group(cluster));
    return std::copy(first, first + size_of(group(cluster)), out);
  }
  return write_members(pairs_[cluster].right, write_members(pairs_[cluster].left, out));
}

void PlocSplitter::write_leaf(Range range, const Share& share, std::span<PrimId> out) const {
  if (share.is_list)
    std::copy_n(list_.data() + range.begin, range.size(), out.data());
  else
    write_members(share.cluster, out.data());
}

}  // namespace boxwood
