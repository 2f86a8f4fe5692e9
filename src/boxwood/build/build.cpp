#include "boxwood/build/build.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "boxwood/build/binned_sah.h"
#include "boxwood/build/longest_axis.h"
#include "boxwood/build/ploc.h"
#include "boxwood/build/reinsertion.h"
#include "boxwood/build/sweep_sah.h"
#include "boxwood/build/top_down.h"

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
  if (!(options.traversal_cost >= 0 && std::isfinite(options.traversal_cost)))
    throw std::invalid_argument("build: traversal_cost is " + std::to_string(options.traversal_cost) +
                                ", expected a finite number that is not negative");
}

}  // namespace

Bvh build(std::span<const Box3> boxes, const BuildOptions& options) {
  check(options);
  if (boxes.size() >= kMaxPrimitives)
    throw std::invalid_argument("build: " + std::to_string(boxes.size()) + " boxes, expected fewer than " +
                                std::to_string(kMaxPrimitives));
  Executor& executor = options.executor != nullptr ? *options.executor : default_executor();
  const auto rounds = static_cast<std::size_t>(options.reinsertion_rounds);
  Meter meter(options.progress, boxes.size() + rounds * reinsertion_work(boxes.size()));
  meter.advance(0);
  const Items items = collect_items(boxes, executor);
  const std::span<Item> full{items.full.data(), items.full.size()};

  // Grow the tree: all methods share the driver and differ in how they split a node.
  const auto grow = [&](auto splitter, bool may_halve) {
    const auto full_count = static_cast<std::uint32_t>(boxes.size() - items.empty_boxes.size());
    Bvh bvh = TopDown(splitter, full_count, items.empty_boxes, options, may_halve, executor, meter).run();
    if (options.reinsertion_rounds > 0)
      bvh =
          reinsert(std::move(bvh), {options.reinsertion_rounds, options.reinsertion_share, options.max_depth},
                   executor, meter);
    meter.finish();
    return bvh;
  };
  switch (options.method) {
    case Method::longest_axis:
      return grow(LongestAxisSplitter(full, options), false);
    case Method::binned_sah:
      return grow(BinnedSahSplitter(items, options, executor), true);
    case Method::sweep_sah:
      return grow(SweepSahSplitter(full, options, executor), true);
    case Method::ploc:
      return grow(PlocSplitter(items, options, executor, meter), true);
  }
  throw std::invalid_argument("build: method is " + std::to_string(static_cast<int>(options.method)) +
                              ", expected longest_axis, binned_sah, sweep_sah or ploc");
}

}  // namespace boxwood
