#include "boxwood/render/light_node.h"

#include "boxwood/core/every_cpu.h"

namespace boxwood::render {

void LightNode::set(int lane, const LightBounds& b) {
  const Vec3 center = b.box.center();
  x[lane] = center.x;
  y[lane] = center.y;
  z[lane] = center.z;
  radius[lane] = 0.5f * length(b.box.extent());
  axis_x[lane] = b.axis.x;
  axis_y[lane] = b.axis.y;
  axis_z[lane] = b.axis.z;
  cos_facing[lane] = b.cos_facing;
  sin_facing[lane] = std::sqrt(max(0.0f, 1 - b.cos_facing * b.cos_facing));
  // A bound of the angle is exact at 90 degrees only: narrower lights that take up room count up to there.
  cos_spread[lane] = radius[lane] > 0 ? min(b.cos_spread, 0.0f) : b.cos_spread;
  strength[lane] = b.strength;
  turned[lane] = b.is_two_sided ? -1.0f : 1.0f;
  least_falloff[lane] = b.cos_facing > -1 ? 0.05f : 1.0f;
}

#define BOXWOOD_LOOPS "boxwood/render/light_node-inl.h"
#include "boxwood/core/every_cpu-inl.h"

float LightNode::weigh(const Receiver& from, Lanes& weights) const {
  return BOXWOOD_BEST(weigh_children)(*this, from, weights);
}

void weigh(const LightNode& node, const Receivers& from, BlockWeights& out) {
  BOXWOOD_BEST(weigh_block)(node, from, out);
}

void pick(const BlockWeights& weights, Floats& choice, Integers& lane, Floats& probability) {
  BOXWOOD_BEST(pick_block)(weights, choice, lane, probability);
}

}  // namespace boxwood::render
