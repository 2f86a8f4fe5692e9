// box_source.h: how does a builder learn the boxes that nobody keeps?
#pragma once

#include <cstddef>
#include <functional>

#include "boxwood/core/box.h"

namespace boxwood {

/// Writes the boxes of the primitives [begin, end) to `out`. Called by several threads at once, for at most
/// kSourceBlock primitives at a time.
using BoxSource = std::function<void(std::size_t begin, std::size_t end, Box3* out)>;
inline constexpr std::size_t kSourceBlock = 256;

}  // namespace boxwood
