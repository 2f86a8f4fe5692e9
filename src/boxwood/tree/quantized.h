// quantized.h: how does a wide node fit into half its bytes?
//
// Each plane becomes one byte: a step on a grid between the ends of the node's own box, rounded outwards, so
// that no box is smaller than it was. A grid's step is a power of two, so step times byte is exact, and a
// plane is one rounded sum: the same bits on every machine, fused or not. Ylitie, Karras and Laine,
// "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017. Sixteen children
// take 192 bytes, eight 128, four 64.
//
// Invariant: the box of a child holds the box that was quantized. It may stick out of the node's own box, by
// less than a step; the box of an empty child is turned inside out, but may look like a point where a step is
// 0 or next to nothing.
#pragma once

#include "boxwood/tree/wide.h"

namespace boxwood {

template <int W>
struct alignas(64) QuantizedNode {
  ChildRef children[W];
  float origin[3], step[3];
  std::uint8_t planes[3][2][W];  ///< Axis; lower, upper; child.

  QuantizedNode() = default;
  explicit QuantizedNode(const WideNode<W>& node);

  Box3 box(int child) const {
    Box3 box;
    for (int k = 0; k < 3; ++k) {
      box.lower[k] = static_cast<float>(planes[k][0][child]) * step[k] + origin[k];
      box.upper[k] = static_cast<float>(planes[k][1][child]) * step[k] + origin[k];
    }
    return box;
  }

  /// The node in full. Empty children get the empty box.
  WideNode<W> widen() const {
    WideNode<W> node;
    for (int c = 0; c < W; ++c)
      if (!children[c].is_empty()) node.set(c, box(c), children[c]);
    return node;
  }
};
static_assert(sizeof(QuantizedNode<16>) == 192 && sizeof(QuantizedNode<8>) == 128 &&
              sizeof(QuantizedNode<4>) == 64);

}  // namespace boxwood
