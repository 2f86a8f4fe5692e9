#include "boxwood/tree/collapse.h"

#include <algorithm>
#include <span>
#include <stdexcept>

#include "boxwood/core/raw_array.h"

namespace boxwood {
namespace {

std::uint32_t blocks_for(std::uint32_t count) {
  return (count + kBlockWidth - 1) / kBlockWidth;
}

constexpr std::uint32_t kMaxLeafSize = kMaxLeafBlocks * kBlockWidth;

/// A subtree from its parent's view.
template <int W>
struct Plan {
  float cost[W - 1];    ///< [n - 1]: the least, as at most n children of a wide node. Never rises with n.
  std::uint16_t steps;  ///< Entries that may differ from the one before: at most the binary leaves.
  std::uint16_t count;  ///< Primitives, or kMaxLeafSize + 1 if there are more.
};
static_assert(sizeof(Plan<16>) == 64 && sizeof(Plan<8>) == 32);

/// What one task emits; references count from 0 in it.
template <int W>
struct Piece {
  std::vector<WideNode<W>> nodes;
  std::vector<PrimId> slots;
};

template <int W>
class Collapser {
 public:
  Collapser(const BvhView& bvh, Executor& executor, WideCost cost)
      : bvh_(bvh), executor_(executor), cost_(cost), plans_(bvh.nodes.size()) {}

  WideBvh<W> run() {
    WideBvh<W> wide;
    if (bvh_.is_empty()) return wide;
    wide.box = bvh_.bounds();

    // Price all subtrees: those that hang below the top as tasks, then the top.
    const std::vector<std::uint32_t> top = list_top();
    std::vector<std::uint32_t> roots;
    for (const std::uint32_t i : top) {
      if (bvh_.nodes[i].is_leaf()) continue;
      for (const std::uint32_t child : {bvh_.nodes[i].first_index, bvh_.nodes[i].first_index + 1})
        if (!is_top_[child]) roots.push_back(child);
    }
    parallel_for(executor_, 0, roots.size(), 1, [&](std::size_t i) { price_subtree(roots[i]); });
    for (std::size_t i = top.size(); i-- > 0;) price(top[i]);
    if (const float area = area_of(wide.box); area > 0) wide.cost = plans_[0].cost[0] / area;

    // Emit the top; whatever hangs below it is a task again.
    Piece<W> head;
    head.nodes.emplace_back();
    std::vector<Hanging> hanging;
    if (is_leaf(0))
      head.nodes[0].set(0, wide.box, emit_leaf(head, 0));
    else
      emit_node(head, 0, 0, &hanging);
    std::vector<Piece<W>> pieces(hanging.size());
    parallel_for(executor_, 0, hanging.size(), 1, [&](std::size_t i) {
      pieces[i].nodes.emplace_back();
      emit_node(pieces[i], 0, hanging[i].binary_index, nullptr);
    });
    return join(std::move(wide), std::move(head), hanging, pieces);
  }

 private:
  /// A wide node that a task will make.
  struct Hanging {
    std::uint32_t parent_index, binary_index;
    int child;
  };

  /// The nodes near the root, parents first: few, but with many subtrees below them.
  std::vector<std::uint32_t> list_top() {
    constexpr std::size_t kTopSize = 512;
    is_top_.assign(bvh_.nodes.size(), false);
    std::vector<std::uint32_t> top = {0};
    is_top_[0] = true;
    for (std::size_t i = 0; i < top.size() && top.size() + 2 <= kTopSize; ++i) {
      const BvhNode& node = bvh_.nodes[top[i]];
      if (node.is_leaf()) continue;
      for (const std::uint32_t child : {node.first_index, node.first_index + 1}) {
        top.push_back(child);
        is_top_[child] = true;
      }
    }
    return top;
  }

  void price_subtree(std::uint32_t i) {
    if (!bvh_.nodes[i].is_leaf()) {
      price_subtree(bvh_.nodes[i].first_index);
      price_subtree(bvh_.nodes[i].first_index + 1);
    }
    price(i);
  }

  void price(std::uint32_t i) {
    const BvhNode& node = bvh_.nodes[i];
    Plan<W>& plan = plans_[i];
    const float area = area_of(node.box);
    if (node.is_leaf()) {
      const std::uint32_t count = node.box.is_empty() ? 0 : node.count;
      plan.steps = 1;
      plan.count = at_most_one_too_many(count);
      std::fill(plan.cost, plan.cost + W - 1, area * cost_.block * float(blocks_for(count)));
      return;
    }
    const Plan<W>*few = &plans_[node.first_index], *many = few + 1;
    if (few->steps > many->steps) std::swap(few, many);
    plan.count = at_most_one_too_many(std::uint32_t(few->count) + many->count);

    // dealt[n - 2]: n children, k of them to one side and the rest to the other, the best k. Most nodes have
    // few leaves below them, and so few ways to deal.
    float dealt[2 * W], padded[W];
    const int most = few->steps + many->steps;
    std::fill(dealt, dealt + 2 * W, kInfinity);
    std::copy(many->cost, many->cost + W - 1, padded);
    padded[W - 1] = kInfinity;
    for (int k = 0; k < few->steps; ++k)
      for (int n = 0; n < many->steps; n += 4)
        for (int lane = n; lane < n + 4; ++lane)
          dealt[k + lane] = std::min(dealt[k + lane], few->cost[k] + padded[lane]);

    // As one child: a wide node of its own, or a leaf.
    plan.cost[0] = std::min(area * cost_.node + dealt[std::min(most, W) - 2], leaf_cost(i, area));
    plan.steps = static_cast<std::uint16_t>(std::min(most, W - 1));
    for (int n = 1; n < W - 1; ++n) plan.cost[n] = std::min(plan.cost[n - 1], dealt[n - 1]);
  }
  static std::uint16_t at_most_one_too_many(std::uint32_t count) {
    return static_cast<std::uint16_t>(std::min(count, kMaxLeafSize + 1));
  }

  static float area_of(const Box3& box) {
    // A float is enough to compare costs; what would overflow costs the same everywhere.
    return static_cast<float>(std::min(half_area(box), 1e30));
  }
  float leaf_cost(std::uint32_t i, float area) const {
    const std::uint32_t count = plans_[i].count;
    return count <= cost_.leaf_size ? area * cost_.block * float(blocks_for(count)) : kInfinity;
  }
  /// Whether a binary node that is one child is a leaf.
  bool is_leaf(std::uint32_t i) const {
    const BvhNode& node = bvh_.nodes[i];
    if (plans_[i].count > kMaxLeafSize) return false;
    return node.is_leaf() || leaf_cost(i, area_of(node.box)) <= plans_[i].cost[0];
  }

  /// Lists the binary nodes that stand for `i` when it may be up to `n` children.
  struct Children {
    std::uint32_t index[W];
    int count = 0;
  };
  void list_children(std::uint32_t i, int n, Children& out) const {
    const Plan<W>& plan = plans_[i];
    if (plan.count == 0) return;
    const BvhNode& node = bvh_.nodes[i];
    if (n < W)
      while (n > 1 && plan.cost[n - 1] == plan.cost[n - 2]) --n;
    if (n == 1 || node.is_leaf()) {
      out.index[out.count++] = i;
      return;
    }

    // Find the deal that gave the cost.
    const Plan<W>&left = plans_[node.first_index], &right = plans_[node.first_index + 1];
    int best = 0;
    float least = kInfinity;
    for (int k = std::max(1, n - (W - 1)); k <= std::min(n - 1, W - 1); ++k) {
      const float cost = left.cost[k - 1] + right.cost[n - k - 1];
      if (best == 0 || cost < least) {
        least = cost;
        best = k;
      }
    }
    list_children(node.first_index, best, out);
    list_children(node.first_index + 1, n - best, out);
  }

  /// Fills piece.nodes[wide_index] with the subtree of binary node `i`. Subtrees below the top are left to
  /// `hanging`, where that is given.
  void emit_node(Piece<W>& piece, std::uint32_t wide_index, std::uint32_t i,
                 std::vector<Hanging>* hanging) const {
    const BvhNode& node = bvh_.nodes[i];
    if (node.is_leaf()) {
      std::vector<PrimId> prims;
      gather(i, prims);
      return emit_crowd(piece, wide_index, node.box, prims);
    }
    Children children;
    list_children(i, W, children);
    std::uint32_t inner[W];
    int inner_count = 0;
    const auto first_node = static_cast<std::uint32_t>(piece.nodes.size());
    for (int c = 0; c < children.count; ++c) {
      const std::uint32_t child = children.index[c];
      ChildRef ref;
      if (is_leaf(child)) {
        ref = emit_leaf(piece, child);
      } else if (hanging && !is_top_[child]) {
        hanging->push_back({wide_index, child, c});
      } else {
        ref = ChildRef::node(first_node + static_cast<std::uint32_t>(inner_count));
        inner[inner_count++] = child;
      }
      piece.nodes[wide_index].set(c, bvh_.nodes[child].box, ref);
    }
    piece.nodes.resize(first_node + static_cast<std::size_t>(inner_count));
    for (int c = 0; c < inner_count; ++c)
      emit_node(piece, first_node + static_cast<std::uint32_t>(c), inner[c], hanging);
  }

  ChildRef emit_leaf(Piece<W>& piece, std::uint32_t i) const {
    const std::size_t first = piece.slots.size();
    gather(i, piece.slots);

    // Parts of one primitive that meet again in a leaf are one; there are a dozen at most.
    auto end = piece.slots.begin() + static_cast<std::ptrdiff_t>(first);
    const auto begin = end;
    for (auto slot = begin; slot != piece.slots.end(); ++slot)
      if (std::find(begin, end, *slot) == end) *end++ = *slot;
    piece.slots.erase(end, piece.slots.end());
    return close_leaf(piece, first);
  }
  void gather(std::uint32_t i, std::vector<PrimId>& out) const {
    const BvhNode& node = bvh_.nodes[i];
    if (plans_[i].count == 0) return;
    if (node.is_leaf()) {
      const auto begin = bvh_.prim_ids.begin() + node.first_index;
      out.insert(out.end(), begin, begin + node.count);
    } else {
      gather(node.first_index, out);
      gather(node.first_index + 1, out);
    }
  }
  /// Makes a leaf of the primitives from slot `first` on: pads its last block with that block's first.
  static ChildRef close_leaf(Piece<W>& piece, std::size_t first) {
    const auto count = static_cast<std::uint32_t>(piece.slots.size() - first);
    const std::uint32_t blocks = blocks_for(count);
    if (blocks == 0) return {};
    const PrimId padding = piece.slots[first + std::size_t(blocks - 1) * kBlockWidth];
    piece.slots.resize(first + std::size_t(blocks) * kBlockWidth, padding);
    return ChildRef::leaf(static_cast<std::uint32_t>(first / kBlockWidth), blocks);
  }

  /// A binary leaf of more primitives than a leaf here may hold: dealt out evenly, all under its box.
  void emit_crowd(Piece<W>& piece, std::uint32_t wide_index, const Box3& box,
                  std::span<const PrimId> prims) const {
    std::size_t share = (prims.size() + W - 1) / W;
    share = (share + kBlockWidth - 1) / kBlockWidth * kBlockWidth;
    for (int c = 0; !prims.empty(); ++c) {
      const std::span<const PrimId> part = prims.first(std::min(share, prims.size()));
      prims = prims.subspan(part.size());
      if (part.size() <= kMaxLeafSize) {
        const std::size_t first = piece.slots.size();
        piece.slots.insert(piece.slots.end(), part.begin(), part.end());
        piece.nodes[wide_index].set(c, box, close_leaf(piece, first));
      } else {
        const auto index = static_cast<std::uint32_t>(piece.nodes.size());
        piece.nodes.emplace_back();
        piece.nodes[wide_index].set(c, box, ChildRef::node(index));
        emit_crowd(piece, index, box, part);
      }
    }
  }

  /// Puts the pieces behind the head, and hangs each where it belongs.
  WideBvh<W> join(WideBvh<W> wide, Piece<W> head, const std::vector<Hanging>& hanging,
                  const std::vector<Piece<W>>& pieces) const {
    std::vector<std::size_t> node_base(pieces.size() + 1), slot_base(pieces.size() + 1);
    node_base[0] = head.nodes.size();
    slot_base[0] = head.slots.size();
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      node_base[p + 1] = node_base[p] + pieces[p].nodes.size();
      slot_base[p + 1] = slot_base[p] + pieces[p].slots.size();
    }
    if (node_base.back() >= 1u << 28 || slot_base.back() / kBlockWidth >= 1u << 28)
      throw std::length_error("collapse: the tree needs 2^28 nodes or blocks or more");
    wide.nodes = std::move(head.nodes);
    wide.slots = std::move(head.slots);
    for (std::size_t p = 0; p < pieces.size(); ++p)
      wide.nodes[hanging[p].parent_index].children[hanging[p].child] =
          ChildRef::node(static_cast<std::uint32_t>(node_base[p]));
    wide.nodes.resize(node_base.back());
    wide.slots.resize(slot_base.back());
    parallel_for(executor_, 0, pieces.size(), 1, [&](std::size_t p) {
      const Piece<W>& piece = pieces[p];
      std::copy(piece.slots.begin(), piece.slots.end(), wide.slots.begin() + std::ptrdiff_t(slot_base[p]));
      const auto nodes_before = static_cast<std::uint32_t>(node_base[p]);
      const auto blocks_before = static_cast<std::uint32_t>(slot_base[p] / kBlockWidth);
      for (std::size_t i = 0; i < piece.nodes.size(); ++i) {
        WideNode<W>& node = wide.nodes[node_base[p] + i] = piece.nodes[i];
        for (ChildRef& child : node.children)
          if (!child.is_empty()) child.bits += (child.is_leaf() ? blocks_before : nodes_before) << 4;
      }
    });
    return wide;
  }

  const BvhView bvh_;
  Executor& executor_;
  const WideCost cost_;
  const RawArray<Plan<W>> plans_;  ///< A plan for each binary node.
  std::vector<bool> is_top_;
};

}  // namespace

template <int W>
WideBvh<W> collapse(const BvhView& bvh, Executor& executor, WideCost cost) {
  return Collapser<W>(bvh, executor, cost).run();
}

template WideBvh<4> collapse<4>(const BvhView&, Executor&, WideCost);
template WideBvh<8> collapse<8>(const BvhView&, Executor&, WideCost);
template WideBvh<16> collapse<16>(const BvhView&, Executor&, WideCost);

}  // namespace boxwood
