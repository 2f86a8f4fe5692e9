#include "boxwood/tree/quantized.h"

#include <algorithm>
#include <cmath>

namespace boxwood {
namespace {

constexpr int kLast = 255;

/// The planes of one axis, between `lower` and `upper`.
struct Grid {
  float origin, step;

  Grid(float lower, float upper) : origin(lower), step(0) {
    if (!(upper > lower)) return;
    // The smallest power of two that reaches the upper end, which the sum's rounding may miss.
    int exponent = std::ilogb((double(upper) - lower) / kLast);
    step = std::max(std::ldexp(1.0f, exponent), 0x1p-149f);
    while (plane(kLast) < upper) step *= 2;
  }

  float plane(int q) const { return static_cast<float>(q) * step + origin; }

  /// The last plane that is not above `x`, and the first that is not below it. Precondition: it is between
  /// the ends.
  int below(float x) const {
    int q = guess(x);
    while (q > 0 && plane(q) > x) --q;
    while (q < kLast && plane(q + 1) <= x && step > 0) ++q;
    return q;
  }
  int above(float x) const {
    int q = guess(x);
    while (q < kLast && plane(q) < x) ++q;
    while (q > 0 && plane(q - 1) >= x) --q;
    return q;
  }

 private:
  int guess(float x) const {
    return step > 0 ? std::clamp(static_cast<int>((double(x) - origin) / step), 0, kLast) : 0;
  }
};

}  // namespace

template <int W>
QuantizedNode<W>::QuantizedNode(const WideNode<W>& node) {
  Box3 around;
  for (int c = 0; c < W; ++c)
    if (!node.children[c].is_empty()) around.extend(node.box(c));
  for (int k = 0; k < 3; ++k) {
    const Grid grid = around.is_empty() ? Grid(0, 0) : Grid(around.lower[k], around.upper[k]);
    origin[k] = grid.origin;
    step[k] = grid.step;
    for (int c = 0; c < W; ++c) {
      children[c] = node.children[c];
      const bool is_empty = node.children[c].is_empty();
      planes[k][0][c] = static_cast<std::uint8_t>(is_empty ? kLast : grid.below(node.planes[k][0][c]));
      planes[k][1][c] = static_cast<std::uint8_t>(is_empty ? 0 : grid.above(node.planes[k][1][c]));
    }
  }
}

template struct QuantizedNode<4>;
template struct QuantizedNode<8>;
template struct QuantizedNode<16>;

}  // namespace boxwood
