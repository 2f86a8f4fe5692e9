// morton_order.h: which primitives are neighbours?
//
// Primitives in the order of their centers' Morton codes (core/morton.h): neighbours in space become
// neighbours in memory, mostly. Where a builder can do with less detail, short runs of that order stand for
// their members.
#pragma once

#include "boxwood/build/item.h"

namespace boxwood {

/// Some neighbours: the box of all, in the place of a primitive's number where they begin in the order, and
/// how many they are.
using Group = Item;
inline std::uint32_t first_of(const Group& group) {
  return group.prim_id.value;
}
inline std::uint32_t size_of(const Group& group) {
  return std::bit_cast<std::uint32_t>(group.unused);
}

/// The order, cut into groups that share a cell.
struct MortonOrder {
  RawArray<Item> items;  ///< Empty when only the ids were asked for.
  RawArray<PrimId> ids;  ///< Empty when the items were asked for.
  RawArray<Group> groups;
};

enum class Keep { items, ids };

/// Brings `items` into Morton order; `centers` is the range of twice their centers. Equal codes keep their
/// order. Groups have at most `group_size` members; a primitive that is much larger than its neighbours is a
/// group of its own, so that it does not drag them along.
MortonOrder in_morton_order(std::span<const Item> items, const Reach& centers, std::uint32_t group_size,
                            Keep keep, Executor& executor);

}  // namespace boxwood
