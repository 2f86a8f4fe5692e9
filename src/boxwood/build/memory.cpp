// memory.cpp: how much memory will a build need?
#include <algorithm>

#include "boxwood/build/build.h"
#include "boxwood/build/item.h"

namespace boxwood {
namespace {

/// Bytes for each primitive.
constexpr double kItem = sizeof(Item), kId = sizeof(PrimId), kKey = 8;
constexpr double kNodes = 2 * sizeof(BvhNode);  // one leaf for each primitive, at worst
constexpr double kTree = kNodes + kId;

/// What a method keeps besides the items; the driver comes on top.
double working_bytes(Method method) {
  switch (method) {
    case Method::longest_axis:
      return 0;
    case Method::binned_sah:
      // Room to part the items in, the items in order, groups and room to part those; often there are six
      // times fewer groups than items, but nothing promises that.
      return 4 * kItem;
    case Method::sweep_sah:
      // On three axes an order, a scratch order and areas; and who goes left.
      return 3 * (4 + 4 + 8) + 1;
    case Method::ploc:
      // Ids in order, groups, and a little more pairs than groups, of 48 bytes; the items are gone when the
      // tree is written.
      return kId + 1.1 * 48;
  }
  return 0;
}

double bytes_for(double count, const BuildOptions& options) {
  const int threads =
      options.executor != nullptr ? options.executor->concurrency() : default_executor().concurrency();

  // The nodes as they were made and in order stand side by side for a moment; clusters are written in order.
  const double growing =
      kItem + working_bytes(options.method) + (options.method == Method::ploc ? 0 : kNodes) + kTree;
  // Later the tree is changed, with a parent for each node, and put in order again.
  const double tries = options.reinsertion_rounds > 0 ? 2 * options.reinsertion_share : 0;
  const double reinserting = 2 * kTree + 8 + tries * (32 + 256.0 * options.reinsertion_rounds);
  // Before there are clusters, items, keys and groups, those before they are in order too, and what each
  // thread works on.
  constexpr double kBlock = 1 << 13;
  const double at_once = std::min<double>(threads, 1 + count / kBlock);
  const double ordering = options.method == Method::ploc
                              ? count * (3 * kItem + kId) + at_once * 2 * kItem * std::min(kBlock, count)
                              : 0;
  // Counters of blocks, and keys while they are sorted.
  return std::max(ordering, count * std::max(growing, options.reinsertion_rounds > 0 ? reinserting : 0.0)) +
         count * kKey + 64e3;
}

}  // namespace

std::size_t build_memory_bytes(std::size_t count, const BuildOptions& options) {
  if (options.split_share == 0) return static_cast<std::size_t>(bytes_for(double(count), options));

  // The builds run beside the pieces; so do the owners' new places.
  const double pieces = double(count) * (1 + double(options.split_share));
  const double beside = 2 * (sizeof(Box3) + kId) * pieces + 8 * double(count);
  BuildOptions quick = options;
  quick.method = Method::ploc;
  quick.reinsertion_rounds = 0;
  return static_cast<std::size_t>(std::max(bytes_for(pieces, options), bytes_for(pieces, quick)) + beside);
}

}  // namespace boxwood
