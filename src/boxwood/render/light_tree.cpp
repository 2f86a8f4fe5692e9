#include "boxwood/render/light_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "boxwood/render/warp.h"

namespace boxwood::render {
namespace {

float clamp_cosine(float c) {
  return min(max(c, -1.0f), 1.0f);
}

/// Bounds of both: the box around both, and a cone around both cones.
LightBounds join(const LightBounds& a, const LightBounds& b) {
  if (!(a.strength > 0)) return b;
  if (!(b.strength > 0)) return a;
  LightBounds out;
  out.box = a.box;
  out.box.extend(b.box);
  out.strength = a.strength + b.strength;
  out.is_two_sided = a.is_two_sided || b.is_two_sided;
  out.cos_spread = min(a.cos_spread, b.cos_spread);

  const LightBounds &wide = a.cos_facing <= b.cos_facing ? a : b, &narrow = &wide == &a ? b : a;
  const float wide_angle = std::acos(clamp_cosine(wide.cos_facing)),
              narrow_angle = std::acos(clamp_cosine(narrow.cos_facing));
  const float between = std::acos(clamp_cosine(dot(wide.axis, narrow.axis)));
  out.axis = wide.axis;
  out.cos_facing = wide.cos_facing;
  if (between + narrow_angle <= wide_angle) return out;  // one holds the other
  const float angle = 0.5f * (wide_angle + between + narrow_angle);
  const Vec3 across = cross(wide.axis, narrow.axis);
  if (angle >= kPi || !(length_squared(across) > 1e-12f)) {
    out.cos_facing = -1;
    return out;
  }
  // Turn the axis of the wide cone towards the other.
  const Vec3 side = cross(normalize(across), wide.axis);
  const float turn = angle - wide_angle;
  out.axis = normalize(wide.axis * std::cos(turn) + side * std::sin(turn));
  // A little wider, for rounding.
  out.cos_facing = max(-1.0f, std::cos(angle) - 1e-5f);
  return out;
}

/// What a node costs: its strength, times the area of its box, times the solid angle that it shines into.
double cost(const LightBounds& b) {
  if (!(b.strength > 0)) return 0;
  const double facing = std::acos(clamp_cosine(b.cos_facing)), spread = std::acos(clamp_cosine(b.cos_spread));
  const double all = std::min(facing + spread, double(kPi));
  const double sine = std::sin(facing);
  const double solid =
      2 * kPi * (1 - b.cos_facing) +
      kPi / 2 * (2 * all * sine - std::cos(facing - 2 * all) - 2 * facing * sine + b.cos_facing);
  const Vec3 e = b.box.extent();
  // Lights in a row have no area; their length counts a little.
  const double area =
      2 * (double(e.x) * e.y + double(e.y) * e.z + double(e.z) * e.x) + 1e-3 * length_squared(e);
  return b.strength * std::max(solid, 1e-6) * area;
}

constexpr std::uint32_t kNoNode = 0xffffffffu;

/// Which child a number below the sum of all weights falls to; and what is left of it there, in [0, 1).
template <class Lanes>
int pick(const Lanes& weights, float& number) {
  Lanes until;
  float sum = 0;
  for (std::size_t lane = 0; lane < weights.size(); ++lane) until[lane] = sum += weights[lane];
  int lane = 0;
  for (const float end : until) lane += end <= number;
  // Rounding may have put it past the last.
  const int count = static_cast<int>(weights.size());
  if (lane == count) do
      --lane;
    while (!(weights[lane] > 0));
  const float left = (number - (lane > 0 ? until[lane - 1] : 0)) / weights[lane];
  number = min(max(left, 0.0f), 0x1.fffffep-1f);
  return lane;
}

}  // namespace

/// A node of the tree as it is built: two children, or a light.
struct LightTree::BinaryNode {
  LightBounds bounds;
  std::uint32_t second = 0;  // the first child follows the node; 0: a leaf
  std::uint32_t light = 0;   // leaf
};

LightTree::LightTree(const std::vector<LightBounds>& lights)
    : leaf_of_light_(lights.size(), Leaf{kNoNode, 0}) {
  std::vector<std::uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  std::erase_if(order, [&](std::uint32_t i) { return !(lights[i].strength > 0); });
  if (order.empty()) return;
  std::vector<BinaryNode> nodes;
  nodes.reserve(2 * order.size());
  build(lights, order.data(), order.data() + order.size(), nodes);
  widen(nodes, 0);
}

/// Makes a node of the lights below `index`: opens the child that costs most until all lanes are taken.
std::uint32_t LightTree::widen(const std::vector<BinaryNode>& nodes, std::uint32_t index) {
  std::array<std::uint32_t, Node::kWidth> children{index};
  int count = 1;
  while (count < Node::kWidth) {
    int dearest = -1;
    double highest = -1;
    for (int i = 0; i < count; ++i) {
      const BinaryNode& child = nodes[children[i]];
      const double price = child.second != 0 ? cost(child.bounds) : -1;
      if (price <= highest) continue;
      highest = price;
      dearest = i;
    }
    if (dearest < 0) break;
    const std::uint32_t opened = children[dearest];
    children[dearest] = opened + 1;
    children[count++] = nodes[opened].second;
  }

  const auto made = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  for (int lane = 0; lane < count; ++lane) {
    const BinaryNode& child = nodes[children[lane]];
    nodes_[made].set(lane, child.bounds);
    if (child.second == 0) {
      nodes_[made].child[lane] = child.light;
      leaf_of_light_[child.light] = {made, static_cast<std::uint32_t>(lane)};
      continue;
    }
    const std::uint32_t below = widen(nodes, children[lane]);
    nodes_[made].child[lane] = below;
    nodes_[made].is_node |= 1u << lane;
    nodes_[below].parent = made;
    nodes_[below].lane_in_parent = static_cast<std::uint32_t>(lane);
  }
  return made;
}

std::uint32_t LightTree::build(const std::vector<LightBounds>& lights, std::uint32_t* begin,
                               std::uint32_t* end, std::vector<BinaryNode>& nodes) {
  const auto index = static_cast<std::uint32_t>(nodes.size());
  nodes.emplace_back();
  if (end - begin == 1) {
    nodes[index].bounds = lights[*begin];
    nodes[index].light = *begin;
    return index;
  }

  // Where to cut: the cheapest of a few planes across each axis (the heuristic of section 4.4).
  constexpr int kBins = 12;
  Box3 centers;
  for (const std::uint32_t* i = begin; i != end; ++i) centers.extend(lights[*i].box.center());
  double best = kInfinity;
  int best_axis = -1, best_bin = 0;
  const auto bin_of = [&](std::uint32_t light, int axis) {
    const float extent = centers.upper[axis] - centers.lower[axis];
    const float x = (lights[light].box.center()[axis] - centers.lower[axis]) / extent;
    return std::clamp(static_cast<int>(x * kBins), 0, kBins - 1);
  };
  for (int axis = 0; axis < 3; ++axis) {
    if (!(centers.upper[axis] > centers.lower[axis])) continue;
    std::array<LightBounds, kBins> bins{};
    std::array<LightBounds, kBins> right{};
    for (const std::uint32_t* i = begin; i != end; ++i) {
      LightBounds& bin = bins[bin_of(*i, axis)];
      bin = join(bin, lights[*i]);
    }
    for (int b = kBins - 1; b > 0; --b) right[b] = b + 1 < kBins ? join(bins[b], right[b + 1]) : bins[b];
    LightBounds left;
    for (int b = 1; b < kBins; ++b) {
      left = join(left, bins[b - 1]);
      if (!(left.strength > 0) || !(right[b].strength > 0)) continue;
      const double sum = cost(left) + cost(right[b]);
      if (sum < best) {
        best = sum;
        best_axis = axis;
        best_bin = b;
      }
    }
  }
  std::uint32_t* middle = begin + (end - begin) / 2;
  if (best_axis >= 0)
    middle = std::stable_partition(begin, end,
                                   [&](std::uint32_t light) { return bin_of(light, best_axis) < best_bin; });
  if (middle == begin || middle == end) middle = begin + (end - begin) / 2;

  build(lights, begin, middle, nodes);
  const std::uint32_t second = build(lights, middle, end, nodes);
  nodes[index].second = second;
  nodes[index].bounds = join(nodes[index + 1].bounds, nodes[second].bounds);
  return index;
}

float LightTree::importance(const Receiver& from) const {
  Lanes weights;
  return is_empty() ? 0 : nodes_[0].weigh(from, weights);
}

std::optional<LightTree::Choice> LightTree::choose(const Receiver& from, float& choice) const {
  if (is_empty()) return std::nullopt;
  return choose_below(0, 1, from, choice);
}

/// Goes on from a node, to which a point came with a probability.
std::optional<LightTree::Choice> LightTree::choose_below(std::uint32_t index, float probability,
                                                         const Receiver& from, float& choice) const {
  for (;;) {
    const Node& node = nodes_[index];
    Lanes weights;
    const float sum = node.weigh(from, weights);
    if (!(sum > 0) || !(sum < kInfinity)) return std::nullopt;
    choice *= sum;
    const int lane = pick(weights, choice);
    probability *= weights[lane] / sum;
    index = node.child[lane];
    if ((node.is_node >> lane & 1) == 0) return Choice{index, probability};
  }
}

void LightTree::choose(const Receivers& from, int count, const BlockWeights& root, Floats& choices,
                       Integers& lights, Floats& probabilities) const {
  Integers lanes;
  pick(root, choices, lanes, probabilities);
  const Node& node = nodes_[0];
  for (int i = 0; i < count; ++i) {
    lights[i] = probabilities[i] > 0 ? node.child[lanes[i]] : 0;
    if ((node.is_node >> lanes[i] & 1) == 0 || !(probabilities[i] > 0)) continue;
    // Below the root each goes its own way.
    const std::optional<Choice> found =
        choose_below(lights[i], probabilities[i], {from.position[i], from.normal[i]}, choices[i]);
    lights[i] = found ? found->light : 0;
    probabilities[i] = found ? found->probability : 0;
  }
}

float LightTree::probability(std::uint32_t light, const Receiver& from) const {
  // From the leaf up to the root.
  float probability = 1;
  for (Leaf at = leaf_of_light_[light]; at.node != kNoNode;) {
    const Node& node = nodes_[at.node];
    Lanes weights;
    const float sum = node.weigh(from, weights);
    if (!(sum > 0) || !(sum < kInfinity)) return 0;
    probability *= weights[at.lane] / sum;
    if (at.node == 0) return probability;
    at = {node.parent, node.lane_in_parent};
  }
  return 0;
}

}  // namespace boxwood::render
