#include "boxwood/build/top_down.h"

namespace boxwood {

std::vector<BvhNode> squeeze(std::span<const BvhNode> sparse, Executor& executor) {
  constexpr std::size_t kBlock = 1 << 15;
  const std::size_t blocks = (sparse.size() + kBlock - 1) / kBlock;
  const auto is_used = [](const BvhNode& node) { return node.count > 0 || node.first_index > 0; };
  const auto block_end = [&](std::size_t block) { return std::min(sparse.size(), (block + 1) * kBlock); };

  // Count the nodes of each block, then those before each block.
  std::vector<std::uint32_t> before(blocks + 1, 0);
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < block_end(block); ++i) before[block + 1] += is_used(sparse[i]);
  });
  for (std::size_t block = 0; block < blocks; ++block) before[block + 1] += before[block];

  // Number the nodes that stay.
  std::vector<std::uint32_t> new_index(sparse.size());
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    std::uint32_t next = before[block];
    for (std::size_t i = block * kBlock; i < block_end(block); ++i) {
      new_index[i] = next;
      next += is_used(sparse[i]);
    }
  });

  // Move them, and point parents to where their children went.
  std::vector<BvhNode> dense(before[blocks]);
  parallel_for(executor, 0, blocks, 1, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < block_end(block); ++i) {
      if (!is_used(sparse[i])) continue;
      BvhNode node = sparse[i];
      if (!node.is_leaf()) node.first_index = new_index[node.first_index];
      dense[new_index[i]] = node;
    }
  });
  return dense;
}

}  // namespace boxwood
