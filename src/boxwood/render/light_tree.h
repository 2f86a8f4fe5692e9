// light_tree.h: which of many lights matters at a point?
//
// A tree over lights that stand somewhere. Each node bounds, for each of up to eight children, where its
// lights are, where they face and how strong they are; a light is drawn by walking down from the root, at
// each node to one of the children, by how much light each could send to the point. All eight are weighed at
// once, by vectors of floats. Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting", HPG 2018 (without the splitting, and with a wider tree); angles are handled by their cosines as
// in Pharr, Jakob and Humphreys, Physically Based Rendering, 4th edition, 12.6.3.
//
// Invariant: a light that could send light to the point is drawn with a chance above 0.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "boxwood/core/box.h"

namespace boxwood::render {

/// A point that light falls on, for the choice of a light.
struct Receiver {
  Vec3 position;
  Vec3 normal;  ///< Towards the side that is lit; unit length. Zero: both sides are.
};

/// What the tree knows of a light, or of many.
struct LightBounds {
  Box3 box;
  Vec3 axis{0, 0, 1};     ///< The lights face directions around this one, of unit length,
  float cos_facing = -1;  ///< within the angle of this cosine,
  float cos_spread = 0;   ///< and shine within the angle of this cosine from where they face.
  float strength = 0;     ///< Irradiance at distance 1, head-on.
  bool is_two_sided = false;
};

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
  /// The chance that choose() returns `light`.
  float probability(std::uint32_t light, const Receiver& from) const;

 private:
  static constexpr int kWidth = 8;
  using Lanes = std::array<float, kWidth>;

  /// The bounds of the children, lane by lane; a lane without a child has no strength.
  struct Node {
    Lanes x{}, y{}, z{}, radius{};  // a sphere around the box
    Lanes axis_x{}, axis_y{}, axis_z{};
    Lanes cos_facing{}, sin_facing{}, cos_spread{};
    Lanes strength{};
    Lanes turned{};         // -1 for lights that shine on both sides, else 1
    Lanes least_falloff{};  // of the irradiance with the angle; 1 for lights that shine all around
    std::array<std::uint32_t, kWidth> child{};
    std::uint32_t is_node = 0;  // bit i: child i is a node, else a light
    std::uint32_t parent = 0, lane_in_parent = 0;

    void set(int lane, const LightBounds& bounds);
    /// How much light each child could send to `from` at most, roughly; and the sum.
    float weigh(const Receiver& from, Lanes& weights) const;
  };
  struct Leaf {
    std::uint32_t node, lane;
  };
  struct BinaryNode;
  static std::uint32_t build(const std::vector<LightBounds>& lights, std::uint32_t* begin, std::uint32_t* end,
                             std::vector<BinaryNode>& nodes);
  std::uint32_t widen(const std::vector<BinaryNode>& nodes, std::uint32_t index);

  std::vector<Node> nodes_;          // the root first
  std::vector<Leaf> leaf_of_light_;  // kNoNode for lights without strength
};

}  // namespace boxwood::render
