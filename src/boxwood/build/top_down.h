// top_down.h: how does a tree grow from its root?
//
// All top-down builders do the same: look at a range of primitives, make it a leaf or split it in two, go on
// with both halves. They differ in one decision, which a Splitter makes; the rest is here, once:
//
//  - Large halves are two tasks. Each subtree owns a part of one node array
//    that is large enough for its worst case (n primitives need at most
//    2n - 2 nodes below their root), so nobody waits and nobody's work moves
//    anybody else's. The gaps are squeezed out at the end. The result is in
//    depth-first order whatever ran when.
//  - Depth. ceil(log2(n / leaf_size)) halvings always suffice; when only that
//    many levels are left, the driver asks for halvings, so a leaf is larger
//    than leaf_size only where max_depth leaves no choice.
//  - Primitives with an empty box get a subtree of their own beside all others, which no query enters.
#pragma once

#include <bit>
#include <concepts>
#include <span>

#include "boxwood/build/item.h"
#include "boxwood/build/meter.h"
#include "boxwood/build/options.h"
#include "boxwood/tree/bvh.h"

namespace boxwood {

/// Positions in a splitter's own order of the primitives.
struct Range {
  std::uint32_t begin, end;
  std::uint32_t size() const { return end - begin; }
};

/// What the driver wants done with a range.
enum class Plan {
  leaf,    ///< No more levels, or nothing to split: only tell the box.
  halve,   ///< Levels are short: both halves the same size, give or take one.
  choose,  ///< The splitter decides.
};

/// What a splitter did with a range: its box, and where the right half begins; range.begin means "a leaf".
struct Step {
  Box3 box;
  std::uint32_t middle;
};

/// Laws: step() reorders positions inside `range` only, and runs for disjoint ranges at the same time. The
/// set of primitives on each side, and the order in which a leaf writes its own, depend on the set in the
/// range only.
template <class S>
concept Splitter = requires(S& splitter, Range range, Plan plan, std::span<PrimId> out) {
  { splitter.step(range, plan) } -> std::same_as<Step>;
  {splitter.write_leaf(range, out)};
};

/// Removes the nodes that were never made (no count and no child) from a node array with gaps, in order.
std::vector<BvhNode> squeeze(std::span<const BvhNode> sparse, Executor& executor);

template <Splitter S>
class TopDown {
 public:
  /// `full_count` primitives are the splitter's, at positions from 0; `empty_boxes` stand behind them.
  TopDown(S& splitter, std::uint32_t full_count, std::span<const PrimId> empty_boxes,
          const BuildOptions& options, bool may_halve, Executor& executor, Meter& meter)
      : splitter_(splitter),
        full_count_(full_count),
        empty_boxes_(empty_boxes),
        options_(options),
        may_halve_(may_halve),
        executor_(executor),
        meter_(meter) {}

  Bvh run() {
    Bvh bvh;
    const auto count = full_count_ + static_cast<std::uint32_t>(empty_boxes_.size());
    if (count == 0) return bvh;
    nodes_.resize(2 * std::size_t(count) - 1);
    bvh.prim_ids.resize(count);
    prim_ids_ = bvh.prim_ids;
    grow_task(0, 1, {0, count}, 0);
    bvh.nodes = squeeze(nodes_, executor_);
    return bvh;
  }

 private:
  /// Smaller ranges are not worth a task, nor a word about progress.
  static constexpr std::uint32_t kTaskSize = 4096;

  /// Grows a subtree whose parent is large, and reports it when nothing below it will.
  void grow_task(std::uint32_t node_index, std::uint32_t base, Range range, int depth) {
    grow(node_index, base, range, depth);
    if (range.size() <= kTaskSize) meter_.advance(range.size());
  }

  /// Grows the subtree of `range` from nodes_[node_index]; its descendants go to nodes_[base] and behind.
  void grow(std::uint32_t node_index, std::uint32_t base, Range range, int depth) {
    const Step step = decide(range, depth);
    if (step.middle == range.begin) {
      nodes_[node_index] = {step.box, range.begin, range.size()};
      write_leaf(range);
      if (range.size() > kTaskSize) meter_.advance(range.size());
      return;
    }
    nodes_[node_index] = {step.box, base, 0};
    const Range left{range.begin, step.middle}, right{step.middle, range.end};
    const std::uint32_t right_base = base + 2 * left.size();
    if (range.size() > kTaskSize) {
      meter_.advance(0);
      executor_.both([&] { grow_task(base, base + 2, left, depth + 1); },
                     [&] { grow_task(base + 1, right_base, right, depth + 1); });
    } else {
      grow(base, base + 2, left, depth + 1);
      grow(base + 1, right_base, right, depth + 1);
    }
  }

  Step decide(Range range, int depth) {
    const Plan plan = plan_for(range.size(), options_.max_depth - depth);
    const Range full{range.begin, min(range.end, full_count_)};
    if (range.end <= full_count_) return splitter_.step(range, plan);

    // Empty boxes: apart from the others first, then halves of them.
    if (range.begin >= full_count_)
      return {Box3{},
              range.begin + (plan == Plan::leaf || range.size() <= leaf_size() ? 0 : range.size() / 2)};
    return {splitter_.step(full, Plan::leaf).box, plan == Plan::leaf ? range.begin : full_count_};
  }

  Plan plan_for(std::uint32_t count, int levels_left) const {
    if (levels_left == 0 || count == 1) return Plan::leaf;
    if (!may_halve_ || count <= leaf_size()) return Plan::choose;
    const std::uint32_t leaves = (count - 1) / leaf_size() + 1;
    const int levels_needed = std::bit_width(leaves - 1);
    return levels_left <= levels_needed ? Plan::halve : Plan::choose;
  }

  void write_leaf(Range range) {
    const Range full{range.begin, min(range.end, full_count_)};
    if (full.begin < full.end) splitter_.write_leaf(full, prim_ids_.subspan(full.begin, full.size()));
    for (std::uint32_t i = max(range.begin, full_count_); i < range.end; ++i)
      prim_ids_[i] = empty_boxes_[i - full_count_];
  }

  static std::uint32_t min(std::uint32_t a, std::uint32_t b) { return a < b ? a : b; }
  static std::uint32_t max(std::uint32_t a, std::uint32_t b) { return a > b ? a : b; }
  std::uint32_t leaf_size() const { return static_cast<std::uint32_t>(options_.leaf_size); }

  S& splitter_;
  const std::uint32_t full_count_;
  const std::span<const PrimId> empty_boxes_;
  const BuildOptions& options_;
  const bool may_halve_;
  Executor& executor_;
  Meter& meter_;
  std::vector<BvhNode> nodes_;  // with gaps
  std::span<PrimId> prim_ids_;
};

}  // namespace boxwood
