// numbers.h: how is a large number read at a glance?
#pragma once

#include <algorithm>
#include <concepts>
#include <string>

#include <fmt/format.h>

namespace boxwood::app {

/// `value` with `decimals` places and a comma before each three digits: 1,443,517.
inline std::string with_commas(double value, int decimals = 0) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  const std::size_t first = text[0] == '-' ? 1 : 0;
  for (std::size_t at = std::min(text.find('.'), text.size()); at > first + 3;) text.insert(at -= 3, ",");
  return text;
}

/// The same for whole numbers (up to 2^53).
template <std::integral Int>
std::string with_commas(Int value) {
  return with_commas(static_cast<double>(value));
}

}  // namespace boxwood::app
