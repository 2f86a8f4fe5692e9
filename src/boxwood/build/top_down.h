// top_down.h: how does a tree grow from its root?
//
// All top-down builders do the same: look at a range of primitives, make it a leaf or split it in two, go on
// with both halves. They differ in one decision, which a Splitter makes; the rest is here, once:
//
//  - Large halves are two tasks. Each subtree owns a part of the numbers up to 2n - 1 that is large enough
//  for
//    its worst case (n primitives need at most 2n - 2 nodes below their root), so nobody waits and nobody's
//    work moves anybody else's. A small subtree uses up its numbers from the front. What lies in memory is
//    only nodes that there are, in the order in which they were made; at the end they are put into the order
//    of their numbers. The result is in depth-first order whatever ran when.
//  - Depth. ceil(log2(n / leaf_size)) halvings always suffice; when only that
//    many levels are left, the driver asks for halvings, so a leaf is larger
//    than leaf_size only where max_depth leaves no choice.
//  - Primitives with an empty box get a subtree of their own beside all others, which no query enters.
#pragma once

#include <algorithm>
#include <bit>
#include <concepts>
#include <mutex>
#include <span>

#include "boxwood/build/item.h"
#include "boxwood/build/meter.h"
#include "boxwood/build/options.h"
#include "boxwood/build/raw_bvh.h"

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
/// A Share is what the splitter wants to be told again when it comes to a half.
template <class Share>
struct Step {
  Box3 box;
  std::uint32_t middle;
  Share left, right;
};

/// The Share of a splitter that keeps nothing.
struct NoShare {};

/// Laws: step() reorders positions inside `range` only, and runs for disjoint ranges at the same time. What
/// it does depends on the range's own primitives and on what was done to the ranges that it came from.
template <class S>
concept Splitter = requires(S& splitter, Range range, Plan plan, const typename S::Share& share,
                            std::span<PrimId> out) {
  { splitter.root() } -> std::same_as<typename S::Share>;
  { splitter.step(range, plan, share) } -> std::same_as<Step<typename S::Share>>;
  {splitter.write_leaf(range, share, out)};
};

/// Nodes numbered from `begin` on, and where they lie.
struct NodeRun {
  std::uint32_t begin, count, place;
};

/// Puts the runs of `nodes` in the order of their numbers; children are found where they went.
RawArray<BvhNode> in_order(const BvhNode* nodes, std::vector<NodeRun> runs, Executor& executor);

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

  RawBvh run() {
    RawBvh bvh;
    const auto count = full_count_ + static_cast<std::uint32_t>(empty_boxes_.size());
    if (count == 0) return bvh;
    nodes_ = RawArray<BvhNode>(2 * std::size_t(count) - 1);
    bvh.prim_ids = RawArray<PrimId>(count);
    prim_ids_ = {bvh.prim_ids.data(), count};
    runs_.push_back({0, 1, 0});
    taken_ = 1;
    grow(nodes_[0], 1, {0, count}, 0, splitter_.root());
    bvh.nodes = in_order(nodes_.data(), std::move(runs_), executor_);
    return bvh;
  }

 private:
  using Share = typename S::Share;

  /// Smaller ranges are not worth a task, nor a word about progress.
  static constexpr std::uint32_t kTaskSize = 4096;

  /// Grows the subtree of `range` from `node`; its descendants are numbered from `base` on.
  void grow(BvhNode& node, std::uint32_t base, Range range, int depth, const Share& share) {
    if (range.size() <= kTaskSize) {
      Small small{RawArray<BvhNode>(2 * std::size_t(range.size())), base};
      grow_small(node, small, range, depth, share);
      if (small.count > 0) std::copy_n(small.nodes.data(), small.count, &nodes_[add_run(base, small.count)]);
      return meter_.advance(range.size());
    }
    const Step<Share> step = decide(range, depth, share);
    if (step.middle == range.begin) {
      make_leaf(node, step.box, range, share);
      return meter_.advance(range.size());
    }
    meter_.advance(0);
    node = {step.box, base, 0};
    BvhNode* const children = &nodes_[add_run(base, 2)];
    const Range left{range.begin, step.middle}, right{step.middle, range.end};
    executor_.both([&] { grow(children[0], base + 2, left, depth + 1, step.left); },
                   [&] { grow(children[1], base + 2 * left.size(), right, depth + 1, step.right); });
  }

  /// The nodes of a task, which stay in the cache until it is done.
  struct Small {
    RawArray<BvhNode> nodes;
    std::uint32_t base, count = 0;
  };

  /// The same for a range that is one task.
  void grow_small(BvhNode& node, Small& small, Range range, int depth, const Share& share) {
    const Step<Share> step = decide(range, depth, share);
    if (step.middle == range.begin) return make_leaf(node, step.box, range, share);
    node = {step.box, small.base + small.count, 0};
    BvhNode* const children = &small.nodes[small.count];
    small.count += 2;
    grow_small(children[0], small, {range.begin, step.middle}, depth + 1, step.left);
    grow_small(children[1], small, {step.middle, range.end}, depth + 1, step.right);
  }

  Step<Share> decide(Range range, int depth, const Share& share) {
    const Plan plan = plan_for(range.size(), options_.max_depth - depth);
    if (range.end <= full_count_) return splitter_.step(range, plan, share);

    // Empty boxes: apart from the others first, then halves of them.
    if (range.begin >= full_count_) {
      const bool is_leaf = plan == Plan::leaf || range.size() <= leaf_size();
      return {Box3{}, range.begin + (is_leaf ? 0 : range.size() / 2), share, share};
    }
    const Range full{range.begin, full_count_};
    return {splitter_.step(full, Plan::leaf, share).box, plan == Plan::leaf ? range.begin : full_count_,
            share, share};
  }

  Plan plan_for(std::uint32_t count, int levels_left) const {
    if (levels_left == 0 || count == 1) return Plan::leaf;
    if (!may_halve_ || count <= leaf_size() || levels_left > static_cast<int>(std::bit_width(count)))
      return Plan::choose;
    const std::uint32_t leaves = (count - 1) / leaf_size() + 1;
    const int levels_needed = std::bit_width(leaves - 1);
    return levels_left <= levels_needed ? Plan::halve : Plan::choose;
  }

  void make_leaf(BvhNode& node, const Box3& box, Range range, const Share& share) {
    node = {box, range.begin, range.size()};
    const Range full{range.begin, min(range.end, full_count_)};
    if (full.begin < full.end) splitter_.write_leaf(full, share, prim_ids_.subspan(full.begin, full.size()));
    for (std::uint32_t i = max(range.begin, full_count_); i < range.end; ++i)
      prim_ids_[i] = empty_boxes_[i - full_count_];
  }

  /// Makes room for `count` nodes, which are numbered from `begin` on. Returns their place.
  std::uint32_t add_run(std::uint32_t begin, std::uint32_t count) {
    std::lock_guard lock(runs_mutex_);
    const std::uint32_t place = taken_;
    taken_ += count;
    runs_.push_back({begin, count, place});
    return place;
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
  RawArray<BvhNode> nodes_;
  std::uint32_t taken_ = 0;  // of nodes_
  std::vector<NodeRun> runs_;
  std::mutex runs_mutex_;
  std::span<PrimId> prim_ids_;
};

}  // namespace boxwood
