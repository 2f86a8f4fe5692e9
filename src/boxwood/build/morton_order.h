// morton_order.h: which primitives are neighbours?
//
// Primitives in the order of their centers' Morton codes (core/morton.h): neighbours in space become
// neighbours in memory, mostly. Where a builder can do with less detail, small runs of that order stand for
// their members.
#pragma once

#include "boxwood/build/item.h"

namespace boxwood {

/// `items` in the order of the Morton codes of their centers; equal codes keep their order. `codes` are
/// theirs.
struct MortonOrder {
  RawArray<Item> items;
  RawArray<std::uint32_t> codes;
};
/// `centers` holds twice the center of each item.
MortonOrder in_morton_order(std::span<const Item> items, const Reach& centers, Executor& executor);

/// A run of at most kGroupSize items of a Morton order that share a cell: the box of all, in the place of a
/// primitive's number where they begin, and how many they are.
using Group = Item;
inline constexpr std::uint32_t kGroupSize = 8;
inline std::uint32_t first_of(const Group& group) {
  return group.prim_id.value;
}
inline std::uint32_t size_of(const Group& group) {
  return std::bit_cast<std::uint32_t>(group.unused);
}

/// Cuts the order into groups. A primitive that is much larger than its neighbours is a group of its own (and
/// moves behind them), so that it does not drag them along.
RawArray<Group> make_groups(MortonOrder& order, Executor& executor);

}  // namespace boxwood
