#include "boxwood/build/reinsertion.h"

#include <algorithm>
#include <queue>

#include "boxwood/build/item.h"

namespace boxwood {
namespace {

/// A search gives up after so many nodes; what it has found until then counts.
constexpr int kMaxVisits = 256;

constexpr std::uint32_t kNone = 0xffffffffu;

struct Move {
  std::uint32_t from = kNone, to = kNone;
  float gain = 0;
};

/// What a round counts for when it is done.
struct Task {
  Meter& meter;
  std::size_t amount;
};

/// A tree that is changed in place: a node's children still lie side by side, but anywhere.
class Workshop {
 public:
  Workshop(const RawBvh& bvh, Executor& executor)
      : nodes_(bvh.nodes.data(), bvh.nodes.size()),
        parent_(bvh.nodes.size()),
        scale_(reach_of(bvh.nodes[0].box)),
        executor_(executor) {
    parallel_for(executor, 0, nodes_.size(), 1 << 14, [&](std::size_t i) {
      const BvhNode& node = nodes_[i];
      if (!node.is_leaf()) parent_[node.first_index] = parent_[node.first_index + 1] = std::uint32_t(i);
    });
    parent_[0] = kNone;
    // Empty boxes have a subtree of their own beside all others: they stay there, and out of all sums.
    if (!nodes_[0].is_leaf() && nodes_[2].box.is_empty()) top_ = 1;
  }

  /// Returns how many were moved.
  std::size_t round(std::size_t tries, const Task& task) {
    const std::vector<std::uint32_t> candidates = largest(tries);
    std::vector<Move> moves(candidates.size());
    executor_.for_range(0, candidates.size(), 1 << 10, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) moves[i] = best_move(candidates[i]);
      task.meter.advance((end - begin) * task.amount / candidates.size());
    });
    std::erase_if(moves, [](const Move& move) { return move.from == kNone; });
    std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.from < b.from;
    });

    // Whoever comes first marks what it changes.
    std::vector<bool> is_taken(nodes_.size(), false);
    std::size_t moved = 0;
    for (const Move& move : moves) {
      const std::uint32_t touched[] = {move.from, sibling(move.from), parent_[move.from], move.to,
                                       parent_[move.to]};
      if (std::any_of(std::begin(touched), std::end(touched), [&](std::uint32_t i) { return is_taken[i]; }))
        continue;
      if (is_below(move.to, move.from)) continue;
      for (const std::uint32_t i : touched) is_taken[i] = true;
      apply(move);
      ++moved;
    }
    return moved;
  }

  /// Makes the tree what it was, which had children behind their parents.
  void undo() {
    for (; !changes_.empty(); changes_.pop_back()) nodes_[changes_.back().first] = changes_.back().second;
    for (std::size_t i = nodes_.size(); i-- > 0;)
      if (!nodes_[i].is_leaf()) fit(i);
  }

  /// The nodes in depth-first order; none where that would be deeper than `max_depth`.
  RawArray<BvhNode> finish(int max_depth) const {
    // Below the top, subtrees are counted and written at the same time; one thread needs no counts.
    const std::size_t most = executor_.concurrency() > 1 ? 512 : 1;
    std::vector<Subtree> subtrees{{0, 0}};
    for (std::size_t next = 0; next < subtrees.size() && subtrees.size() < most; ++next) {
      Subtree& subtree = subtrees[next];
      const BvhNode& node = nodes_[subtree.root];
      if (node.is_leaf()) continue;
      subtree.left = static_cast<std::uint32_t>(subtrees.size());
      const int depth = subtree.depth + 1;
      subtrees.push_back({node.first_index, depth});
      subtrees.push_back({node.first_index + 1, depth});
    }
    if (most > 1)
      parallel_for(executor_, 0, subtrees.size(), 1, [&](std::size_t i) {
        if (subtrees[i].left == kNone) subtrees[i].below = count_below(subtrees[i].root);
      });
    for (std::size_t i = subtrees.size(); i-- > 0;) {
      Subtree& subtree = subtrees[i];
      if (subtree.left == kNone) continue;
      const Subtree &left = subtrees[subtree.left], &right = subtrees[subtree.left + 1];
      subtree.below = 2 + left.below + right.below;
    }

    // Deal out the places, from the root down.
    RawArray<BvhNode> out(nodes_.size());
    subtrees[0].base = 1;
    for (const Subtree& subtree : subtrees) {
      out[subtree.place] = nodes_[subtree.root];
      if (subtree.left == kNone) continue;
      out[subtree.place].first_index = subtree.base;
      Subtree &left = subtrees[subtree.left], &right = subtrees[subtree.left + 1];
      left.place = subtree.base;
      right.place = subtree.base + 1;
      left.base = subtree.base + 2;
      right.base = left.base + left.below;
    }
    parallel_for(executor_, 0, subtrees.size(), 1, [&](std::size_t i) {
      if (subtrees[i].left == kNone) subtrees[i].deepest = write(subtrees[i], out);
    });
    const bool is_too_deep = std::any_of(subtrees.begin(), subtrees.end(),
                                         [&](const Subtree& subtree) { return subtree.deepest > max_depth; });
    return is_too_deep ? RawArray<BvhNode>() : std::move(out);
  }

 private:
  /// A part of the tree, and where it goes: its root to `place`, all below it from `base` on.
  struct Subtree {
    std::uint32_t root;
    int depth;                   ///< Of its root.
    std::uint32_t left = kNone;  ///< Where its children's subtrees are listed; kNone: they are not.
    std::uint32_t below = 0;     ///< How many.
    int deepest = 0;             ///< Known when it is written.
    std::uint32_t place = 0, base = 0;
  };

  std::uint32_t count_below(std::uint32_t root) const {
    std::uint32_t count = 0;
    std::vector<std::uint32_t> waiting{root};
    while (!waiting.empty()) {
      const BvhNode& node = nodes_[waiting.back()];
      waiting.pop_back();
      if (node.is_leaf()) continue;
      count += 2;
      waiting.push_back(node.first_index);
      waiting.push_back(node.first_index + 1);
    }
    return count;
  }
  /// Returns the depth of the deepest node.
  int write(const Subtree& subtree, const RawArray<BvhNode>& out) const {
    struct Place {
      std::uint32_t index;
      int depth;
    };
    std::vector<Place> waiting{{subtree.place, subtree.depth}};
    std::uint32_t next = subtree.base;
    int deepest = 0;
    while (!waiting.empty()) {
      const auto [index, depth] = waiting.back();
      waiting.pop_back();
      deepest = std::max(deepest, depth);
      BvhNode& node = out[index];
      if (node.is_leaf()) continue;
      // Children are noted as they were, and corrected when their turn comes.
      const BvhNode* children = &nodes_[node.first_index];
      node.first_index = next;
      out[next] = children[0];
      out[next + 1] = children[1];
      waiting.push_back({next + 1, depth + 1});
      waiting.push_back({next, depth + 1});
      next += 2;
    }
    return deepest;
  }

  static Reach reach_of(const Box3& box) {
    return {{Lanes::Register{-box.lower.x, -box.lower.y, -box.lower.z, 0}},
            {Lanes::Register{box.upper.x, box.upper.y, box.upper.z, 0}}};
  }
  Reach reach(std::uint32_t i) const { return reach_of(nodes_[i].box); }
  float area(const Reach& reach) const { return scale_.area(reach); }
  std::uint32_t sibling(std::uint32_t i) const {
    const std::uint32_t first = nodes_[parent_[i]].first_index;
    return i == first ? first + 1 : first;
  }

  /// Whether an earlier move has brought `node` below `other`.
  bool is_below(std::uint32_t node, std::uint32_t other) const {
    while (node != kNone && node != other) node = parent_[node];
    return node == other;
  }

  /// The nodes with the largest areas, but the top and its children. A child is no larger than its parent, so
  /// they hang together.
  std::vector<std::uint32_t> largest(std::size_t count) const {
    using Entry = std::pair<float, std::uint32_t>;
    std::priority_queue<Entry> open;
    const auto open_children = [&](std::uint32_t i) {
      if (nodes_[i].is_leaf()) return;
      for (const std::uint32_t child : {nodes_[i].first_index, nodes_[i].first_index + 1})
        open.push({area(reach(child)), child});
    };
    std::vector<std::uint32_t> found;
    open_children(top_);
    while (!open.empty() && found.size() < count) {
      const std::uint32_t i = open.top().second;
      open.pop();
      if (parent_[i] != top_) found.push_back(i);
      open_children(i);
    }
    return found;
  }

  /// Looks for the place where `from` is put back for the least area: below its sibling, then below the
  /// sibling of its parent, and so on up to the root.
  Move best_move(std::uint32_t from) const {
    Move best;
    const Reach own = reach(from);
    const float own_area = area(own);
    const std::uint32_t parent = parent_[from];

    // What taking it out saves: its parent goes, and all above become smaller.
    float saved = area(reach(parent));
    Reach rest = reach(sibling(from));
    std::uint32_t start = sibling(from), pivot = parent;
    int visits = 0;
    struct Open {
      float left;  // of what was saved, when all above the node have grown
      std::uint32_t node;
    };
    Open waiting[2 * kMaxDepth + 2];
    while (true) {
      int size = 0;
      waiting[size++] = {saved, start};
      while (size > 0 && visits < kMaxVisits) {
        const Open open = waiting[--size];
        // A new parent is at least as large as what it is for.
        if (open.left - own_area <= best.gain) continue;
        ++visits;
        const BvhNode& node = nodes_[open.node];
        const Reach there = reach_of(node.box);
        Reach both = own;
        both.extend(there);
        const float left = open.left - area(both);
        if (left > best.gain && open.node != sibling(from)) best = {from, open.node, left};
        if (node.is_leaf() || size + 2 > int(std::size(waiting))) continue;
        const float below = left + area(there);
        waiting[size++] = {below, node.first_index};
        waiting[size++] = {below, node.first_index + 1};
      }

      // One level up.
      if (pivot != parent) {
        rest.extend(reach(start));
        saved += area(reach(pivot)) - area(rest);
      }
      if (pivot == top_ || visits >= kMaxVisits) return best;
      start = sibling(pivot);
      pivot = parent_[pivot];
    }
  }

  /// The sibling takes the parent's place; the two places that it leaves become the children of the new
  /// parent, which stands where `to` stood.
  void apply(const Move& move) {
    const std::uint32_t other = sibling(move.from), parent = parent_[move.from];
    const std::uint32_t pair = nodes_[parent].first_index;
    for (const std::uint32_t i : {parent, other, move.to}) changes_.emplace_back(i, nodes_[i]);
    put(parent, nodes_[other]);
    put(other, nodes_[move.to]);
    nodes_[move.to].count = 0;
    nodes_[move.to].first_index = pair;
    parent_[move.from] = parent_[other] = move.to;
    refit(move.to);
    refit(parent_[parent]);
  }
  void put(std::uint32_t place, const BvhNode node) {
    nodes_[place] = node;
    if (!node.is_leaf()) parent_[node.first_index] = parent_[node.first_index + 1] = place;
  }
  void refit(std::uint32_t i) {
    for (; i != kNone; i = parent_[i]) fit(i);
  }
  void fit(std::size_t i) {
    nodes_[i].box = unite(nodes_[nodes_[i].first_index].box, nodes_[nodes_[i].first_index + 1].box);
  }

  const std::span<BvhNode> nodes_;
  RawArray<std::uint32_t> parent_;
  const Scale scale_;
  Executor& executor_;
  std::vector<std::pair<std::uint32_t, BvhNode>> changes_;  ///< What stood where, before each.
  std::uint32_t top_ = 0;                                   ///< Of the subtree that is changed.
};

}  // namespace

RawBvh reinsert(RawBvh bvh, const Reinsertion& how, Executor& executor, Meter& meter) {
  if (bvh.nodes.size() < 7) return bvh;
  Workshop workshop(bvh, executor);
  const auto tries = static_cast<std::size_t>(how.share * float(bvh.nodes.size())) + 1;
  std::size_t moved = 0;
  for (int round = 0; round < how.rounds; ++round) {
    meter.advance(0);
    const std::size_t now = workshop.round(tries, {meter, reinsertion_work(bvh.prim_ids.size())});
    moved += now;
    if (now == 0) break;
  }
  if (moved == 0) return bvh;
  if (RawArray<BvhNode> nodes = workshop.finish(how.max_depth); nodes.size() > 0)
    bvh.nodes = std::move(nodes);
  else
    workshop.undo();
  return bvh;
}

}  // namespace boxwood
