// light_node-inl.h: the loops of light_node.h.
//
// Included once for each instruction set, in a namespace of its own; no include guard.

inline float weigh_children(const LightNode& node, const Receiver& from, LightNode::Lanes& weights) {
  const float least_cos_in = length_squared(from.normal) > 0 ? 0.0f : 1.0f;
  LightNode::Lanes out;
  for (int lane = 0; lane < LightNode::kWidth; ++lane)
    out[lane] = node[lane].weight(from.position, from.normal, least_cos_in);
  weights = out;
  return LightNode::sum(out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7]);
}

template <bool kTurns>
inline void weigh_child(const LightChild child, const Receivers& __restrict from,
                        Floats& __restrict weights) {
  for (int i = 0; i < kBlock; ++i) {
    const Vec3 normal = from.normal[i];
    weights[i] = child.weight<kTurns>(from.position[i], normal, length_squared(normal) > 0 ? 0.0f : 1.0f);
  }
}

inline void weigh_block(const LightNode& node, const Receivers& from, BlockWeights& out) {
  for (int lane = 0; lane < LightNode::kWidth; ++lane) {
    const LightChild child = node[lane];
    // Most nodes of a small scene are not full, and their lights are flat.
    if (!(child.strength > 0))
      out.of_child[lane].fill(0);
    else if (child.sin_facing > 0)
      weigh_child<true>(child, from, out.of_child[lane]);
    else
      weigh_child<false>(child, from, out.of_child[lane]);
  }
  const auto& w = out.of_child;
  for (int i = 0; i < kBlock; ++i)
    out.sum[i] = LightNode::sum(w[0][i], w[1][i], w[2][i], w[3][i], w[4][i], w[5][i], w[6][i], w[7][i]);
}

inline void pick_block(const BlockWeights& weights, Floats& choice, Integers& lane, Floats& probability) {
  for (int i = 0; i < kBlock; ++i) {
    const float sum = weights.sum[i], number = choice[i] * sum;
    // The first child at whose end the running sum is above the number, or the last that sends light:
    // rounding may have put the number past that. Its weight, and the sum before it.
    float end = 0, before = 0, weight = 0;
    std::uint32_t picked = 0;
    bool is_found = false;
    for (int k = 0; k < LightNode::kWidth; ++k) {
      const float own = weights.of_child[k][i];
      const bool is_it = !is_found & (own > 0);
      before = is_it ? end : before;
      weight = is_it ? own : weight;
      picked = is_it ? static_cast<std::uint32_t>(k) : picked;
      end += own;
      is_found = is_found | (end > number);
    }
    const bool is_usable = (sum > 0) & (sum < kInfinity);
    lane[i] = picked;
    probability[i] = is_usable ? weight / sum : 0.0f;
    choice[i] = min(max((number - before) / weight, 0.0f), 0x1.fffffep-1f);
  }
}
