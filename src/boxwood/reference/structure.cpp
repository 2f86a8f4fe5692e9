#include "boxwood/reference/structure.h"

#include <stdexcept>
#include <string>

namespace boxwood::reference {

Box3 checked_bounds(std::span<const Box3> boxes) {
  if (boxes.size() >= PrimId::kNone)
    throw std::invalid_argument("reference: " + std::to_string(boxes.size()) +
                                " boxes, expected fewer than 2^32 - 1");
  Box3 bounds;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i] == Box3{}) continue;
    if (!is_finite(boxes[i].lower) || !is_finite(boxes[i].upper) || boxes[i].is_empty())
      throw std::invalid_argument(
          "reference: box " + std::to_string(i) +
          " is not finite, expected finite corners with lower <= upper, or the empty box");
    bounds.extend(boxes[i]);
  }
  return bounds;
}

}  // namespace boxwood::reference
