// light_tree.h: which of many lights matters at a point?
//
// A tree over lights that stand somewhere. Each node bounds, for each of up to eight children, where its
// lights are, where they face and how strong they are; a light is drawn by walking down from the root, at
// each node to one of the children, by how much light each could send to the point. All eight are weighed at
// once, by vectors of floats. Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting", HPG 2018 (without the splitting, and with a wider tree); angles are handled by their cosines as
// in Pharr, Jakob and Humphreys, Physically Based Rendering, 4th edition, 12.6.3. A block of points walks
// down together as far as its paths are one: the root is weighed for all of them at once.
//
// Invariant: a light that could send light to the point is drawn with a chance above 0.
#pragma once

#include <optional>
#include <vector>

#include "boxwood/render/light_node.h"

namespace boxwood::render {

class LightTree {
 public:
  /// Lights are named by their position in `lights`.
  explicit LightTree(const std::vector<LightBounds>& lights);
  LightTree() = default;

  bool is_empty() const { return nodes_.empty(); }
  /// How much light could come to `from` in all, roughly; 0 only where there is none.
  float importance(const Receiver& from) const;

  struct Choice {
    std::uint32_t light;
    float probability;
  };
  /// A light for `from`; nothing when none reaches it. `choice` is uniform in [0, 1), and what is left of it
  /// on return is so again.
  std::optional<Choice> choose(const Receiver& from, float& choice) const;
  /// The same for the first `count` points of a block, by what weigh_root() found for them. Where a
  /// probability is 0 there is no light.
  void choose(const Receivers& from, int count, const BlockWeights& root, Floats& choices, Integers& lights,
              Floats& probabilities) const;
  /// The sums are importance() of each point. Precondition: not empty.
  void weigh_root(const Receivers& from, BlockWeights& out) const { weigh(nodes_[0], from, out); }

  /// The chance that choose() returns `light`.
  float probability(std::uint32_t light, const Receiver& from) const;

 private:
  using Node = LightNode;
  using Lanes = LightNode::Lanes;
  struct Leaf {
    std::uint32_t node, lane;
  };
  std::optional<Choice> choose_below(std::uint32_t node, float probability, const Receiver& from,
                                     float& choice) const;
  struct BinaryNode;
  static std::uint32_t build(const std::vector<LightBounds>& lights, std::uint32_t* begin, std::uint32_t* end,
                             std::vector<BinaryNode>& nodes);
  std::uint32_t widen(const std::vector<BinaryNode>& nodes, std::uint32_t index);

  std::vector<Node> nodes_;          // the root first
  std::vector<Leaf> leaf_of_light_;  // kNoNode for lights without strength
};

}  // namespace boxwood::render
