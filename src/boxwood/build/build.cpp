#include "boxwood/build/build.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "boxwood/build/binned_sah.h"
#include "boxwood/build/longest_axis.h"
#include "boxwood/build/ploc.h"
#include "boxwood/build/reinsertion.h"
#include "boxwood/build/sweep_sah.h"
#include "boxwood/build/top_down.h"
#include "boxwood/tree/metrics.h"

namespace boxwood {
namespace {

void require_range(const char* name, int value, int lowest, int highest) {
  if (value < lowest || value > highest)
    throw std::invalid_argument(std::string("build: ") + name + " is " + std::to_string(value) +
                                ", expected " + std::to_string(lowest) + " to " + std::to_string(highest));
}

void check(const BuildOptions& options) {
  require_range("max_depth", options.max_depth, 0, kMaxDepth);
  require_range("leaf_size", options.leaf_size, 1, std::numeric_limits<int>::max());
  require_range("block_size", options.block_size, 1, std::numeric_limits<int>::max());
  require_range("bins", options.bins, 2, kMaxBins);
  require_range("reinsertion_rounds", options.reinsertion_rounds, 0, 1000);
  if (!(options.reinsertion_share >= 0 && options.reinsertion_share <= 1))
    throw std::invalid_argument("build: reinsertion_share is " + std::to_string(options.reinsertion_share) +
                                ", expected 0 to 1");
  if (!(options.split_share >= 0 && options.split_share <= 4))
    throw std::invalid_argument("build: split_share is " + std::to_string(options.split_share) +
                                ", expected 0 to 4");
  if (!(options.traversal_cost >= 0 && std::isfinite(options.traversal_cost)))
    throw std::invalid_argument("build: traversal_cost is " + std::to_string(options.traversal_cost) +
                                ", expected a finite number that is not negative");
}

/// The methods that split from the top share the driver. Whatever they keep is gone afterwards.
RawBvh grow_tree(std::size_t count, const BoxSource& source, const BuildOptions& options, Executor& executor,
                 Meter& meter) {
  Items items = collect_items(count, source, executor);
  const std::span<Item> full{items.full.data(), items.full.size()};
  const auto grow = [&](auto splitter, bool may_halve) {
    const auto full_count = static_cast<std::uint32_t>(items.full.size());
    return TopDown(splitter, full_count, items.empty_boxes, options, may_halve, executor, meter).run();
  };
  switch (options.method) {
    case Method::longest_axis:
      return grow(LongestAxisSplitter(full, options), false);
    case Method::binned_sah:
      return grow(BinnedSahSplitter(items, options, executor), true);
    case Method::sweep_sah:
      return grow(SweepSahSplitter(full, options, executor), true);
    case Method::ploc: {
      PlocBuilder clusters(items, options, executor, meter);
      items.full = {};
      return clusters.tree(items.empty_boxes, source, executor, meter);
    }
  }
  throw std::invalid_argument("build: method is " + std::to_string(static_cast<int>(options.method)) +
                              ", expected longest_axis, binned_sah, sweep_sah or ploc");
}

/// Names the owners in place of the pieces, each once in a leaf.
void name_owners(Bvh& bvh, std::span<const PrimId> owners) {
  std::vector<std::uint32_t> kept_before(bvh.prim_ids.size() + 1, 0);
  for (BvhNode& node : bvh.nodes) {
    if (!node.is_leaf()) continue;
    const auto first = bvh.prim_ids.begin() + node.first_index, last = first + node.count;
    for (auto id = first; id != last; ++id) *id = owners[id->value];
    std::sort(first, last);
    node.count = static_cast<std::uint32_t>(std::unique(first, last) - first);
    for (std::uint32_t k = 0; k < node.count; ++k) kept_before[node.first_index + k + 1] = 1;
  }
  // Close the gaps.
  for (std::size_t i = 0; i < bvh.prim_ids.size(); ++i) {
    const bool is_kept = kept_before[i + 1] > 0;
    kept_before[i + 1] += kept_before[i];
    if (is_kept) bvh.prim_ids[kept_before[i]] = bvh.prim_ids[i];
  }
  bvh.prim_ids.resize(kept_before.back());
  for (BvhNode& node : bvh.nodes)
    if (node.is_leaf()) node.first_index = kept_before[node.first_index];
}

/// Tells `progress` of one part of the work as the share [begin, end] of all.
Progress part_of(const Progress& progress, double begin, double end) {
  if (!progress) return nullptr;
  return [&progress, begin, end](std::string_view stage, double done) {
    return progress(stage, begin + (end - begin) * done);
  };
}

}  // namespace

RawBvh build_raw(std::size_t count, const BoxSource& source, const BuildOptions& options) {
  check(options);
  if (count >= kMaxPrimitives)
    throw std::invalid_argument("build: " + std::to_string(count) + " boxes, expected fewer than " +
                                std::to_string(kMaxPrimitives));
  Executor& executor = options.executor != nullptr ? *options.executor : default_executor();
  const auto rounds = static_cast<std::size_t>(options.reinsertion_rounds);
  Meter meter(options.progress, count + rounds * reinsertion_work(count));
  meter.advance(0);

  RawBvh bvh = grow_tree(count, source, options, executor, meter);
  if (rounds > 0)
    bvh = reinsert(std::move(bvh), {options.reinsertion_rounds, options.reinsertion_share, options.max_depth},
                   executor, meter);
  meter.finish();
  return bvh;
}

Bvh build(std::span<const Box3> boxes, const BuildOptions& options) {
  const BoxSource source = [boxes](std::size_t begin, std::size_t end, Box3* out) {
    std::copy(boxes.begin() + std::ptrdiff_t(begin), boxes.begin() + std::ptrdiff_t(end), out);
  };
  const RawBvh raw = build_raw(boxes.size(), source, options);
  return {{raw.nodes.begin(), raw.nodes.end()}, {raw.prim_ids.begin(), raw.prim_ids.end()}};
}

Bvh build(std::span<const Box3> boxes, const Clip& clip, const BuildOptions& options) {
  check(options);
  if (options.split_share == 0) return build(boxes, options);
  Executor& executor = options.executor != nullptr ? *options.executor : default_executor();

  for (std::size_t i = 0; i < boxes.size(); ++i) check_box(boxes, i);

  // Whether pieces pay is known only from trees; quick ones will do.
  if (!may_pay_to_split(boxes, executor)) return build(boxes, options);
  const Pieces pieces = split_spatially(boxes, clip, options.split_share, executor);
  BuildOptions part = options;
  part.method = Method::ploc;
  part.reinsertion_rounds = 0;
  part.progress = part_of(options.progress, 0, 0.1);
  const double whole_cost = sah_cost(build(boxes, part), options.traversal_cost);
  part.progress = part_of(options.progress, 0.1, 0.2);
  Bvh split = build(pieces.boxes, part);
  name_owners(split, pieces.owners);
  const bool is_better = sah_cost(split, options.traversal_cost) < whole_cost;
  split = {};

  part = options;
  part.progress = part_of(options.progress, 0.2, 1);
  if (!is_better) return build(boxes, part);
  split = build(pieces.boxes, part);
  name_owners(split, pieces.owners);
  return split;
}

}  // namespace boxwood
