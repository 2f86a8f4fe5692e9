// gallery.h: which scenes can the program make by itself?
//
// By name, so that every command works with no file at hand: "stilllife", "spheres:10000", "soup:1000000",
// "terrain:512", "cornell", "city:500", "duplicates:1000".
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "boxwood/scene/description.h"

namespace boxwood::gallery {

struct Entry {
  std::string_view name;         ///< Before the colon.
  std::string_view description;  ///< One line for help texts.
  std::uint64_t default_size;    ///< 0: the scene has no size.
  std::uint64_t max_size;
};

/// Every scene that make() knows.
std::span<const Entry> entries();

/// Whether `name` (the part before a colon) is one of them.
bool is_known(std::string_view name);

/// Makes a scene, the same each time. Throws std::invalid_argument for a name that is not known, a size that
/// is not a number, or one out of range; the message says what was expected.
SceneDesc make(std::string_view name);

}  // namespace boxwood::gallery
