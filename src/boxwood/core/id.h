// id.h: what does a user call a thing by?
//
// A stable name that is handed to users is an Id, and each kind is a type of its own. A position in one of
// our own arrays is a plain std::uint32_t whose name ends in `_index`; the two never convert silently.
#pragma once

#include <compare>
#include <cstdint>

namespace boxwood {

/// A stable name; `value` counts from 0 in the order in
/// which the user gave the things. Default: no thing at all.
template <class Tag>
struct Id {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t value = kNone;

  constexpr Id() = default;
  constexpr explicit Id(std::uint64_t v) : value(static_cast<std::uint32_t>(v)) {}
  constexpr bool is_valid() const { return value != kNone; }
  friend constexpr auto operator<=>(const Id&, const Id&) = default;
};

using PrimId = Id<struct PrimTag>;          ///< A triangle of a mesh, a shape of a span.
using GeometryId = Id<struct GeometryTag>;  ///< A mesh, or a set of shapes, of a scene.
using InstanceId = Id<struct InstanceTag>;  ///< One placement of a geometry in a scene.
using MaterialId = Id<struct MaterialTag>;
using TextureId = Id<struct TextureTag>;

}  // namespace boxwood
