// light_node.h: how much light can each of a few groups of lights send to a point?
//
// A node of the light tree (light_tree.h): for each of up to eight children, where its lights are, where they
// face and how strong they are. One formula weighs a child for a point; the loops over it run over the
// children for one point, or over the points of a block for each child, and are vectors either way.
#pragma once

#include "boxwood/core/block.h"
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

/// Receivers of a block.
struct Receivers {
  Vec3s position, normal;
};

/// One child.
struct LightChild {
  float x, y, z, radius;  // a sphere around the box
  float axis_x, axis_y, axis_z, cos_facing, sin_facing, cos_spread;
  float strength;
  float turned;         // -1 for lights that shine on both sides, else 1
  float least_falloff;  // of the irradiance with the angle; 1 for lights that shine all around

  /// How much light it could send at most, roughly, to the point `p` with the normal `n`; `least_cos_in` is 1
  /// where the normal is zero, else 0.
  ///
  /// The estimate is strength / distance^2, by the cosines at the light and at the surface. Seen from the
  /// surface the lights are within an angle r of the middle of their sphere, so an angle t may be t - r in
  /// truth. For its cosine stands cos t + sin r: above 0 exactly where cos(t - r) is, and no less where that
  /// is below 0. Selects in place of branches, for vectors.
  ///
  /// `kTurns` is whether the lights face more than one direction, or there may be such.
  template <bool kTurns = true>
  float weight(Vec3 p, Vec3 n, float least_cos_in) const {
    const float to_x = x - p.x, to_y = y - p.y, to_z = z - p.z;
    const float distance_squared = max(to_x * to_x + to_y * to_y + to_z * to_z, 1e-30f);
    const float per_distance = 1 / std::sqrt(distance_squared);
    // Inside the sphere the distance to its middle says nothing, and neither do directions.
    const float sin_reach = radius * per_distance;
    const float reach = sin_reach < 1 ? sin_reach : 2.0f;

    // From where the lights face towards the surface, less their cone.
    const float along = -(axis_x * to_x + axis_y * to_y + axis_z * to_z) * per_distance;
    const float cos_axis = max(min(max(along, turned * along), 1.0f), -1.0f);
    const float beside = kTurns ? std::sqrt(1 - cos_axis * cos_axis) * sin_facing : 0.0f;
    const float outside_cone = cos_axis * cos_facing + beside;
    const float cos_away = cos_axis > cos_facing ? 1.0f : outside_cone;
    const float cos_emitted = min(cos_away + reach, 1.0f);

    const float cos_normal = (n.x * to_x + n.y * to_y + n.z * to_z) * per_distance;
    const float cos_in = max(min(cos_normal + reach, 1.0f), least_cos_in);

    const float irradiance = strength / max(distance_squared, radius * radius);
    const float weight = irradiance * (max(cos_emitted, least_falloff) * cos_in);
    return cos_emitted > cos_spread ? weight : 0.0f;
  }
};

/// Children lane by lane; a lane without a child has no strength.
struct LightNode {
  static constexpr int kWidth = 8;
  using Lanes = std::array<float, kWidth>;

  Lanes x{}, y{}, z{}, radius{};
  Lanes axis_x{}, axis_y{}, axis_z{};
  Lanes cos_facing{}, sin_facing{}, cos_spread{};
  Lanes strength{};
  Lanes turned{}, least_falloff{};
  std::array<std::uint32_t, kWidth> child{};
  std::uint32_t is_node = 0;  // bit i: child i is a node, else a light
  std::uint32_t parent = 0, lane_in_parent = 0;

  void set(int lane, const LightBounds& bounds);

  LightChild operator[](int i) const {
    return {x[i],          y[i],          z[i],          radius[i],   axis_x[i], axis_y[i],       axis_z[i],
            cos_facing[i], sin_facing[i], cos_spread[i], strength[i], turned[i], least_falloff[i]};
  }
  /// The weights of all children for one point; and their sum.
  float weigh(const Receiver& from, Lanes& weights) const;

  /// The sum of weights, in the order in which vectors are summed up.
  static constexpr float sum(float a, float b, float c, float d, float e, float f, float g, float h) {
    return ((a + e) + (c + g)) + ((b + f) + (d + h));
  }
};

/// The weights of a node's children for all points of a block, and their sums.
struct BlockWeights {
  std::array<Floats, LightNode::kWidth> of_child{};
  Floats sum{};
};
void weigh(const LightNode& node, const Receivers& from, BlockWeights& out);

/// Which child each point's choice, uniform in [0, 1), falls to, and with which probability: 0 where no child
/// sends light. What is left of the choice is uniform in [0, 1) again.
void pick(const BlockWeights& weights, Floats& choice, Integers& lane, Floats& probability);

}  // namespace boxwood::render
