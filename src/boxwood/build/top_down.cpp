#include "boxwood/build/top_down.h"

#include <algorithm>
#include <cstring>

namespace boxwood {

RawArray<BvhNode> in_order(const BvhNode* nodes, std::vector<NodeRun> runs, Executor& executor) {
  // Runs were noted as they were made: bring them into the order of their numbers, and count what lies
  // before.
  std::sort(runs.begin(), runs.end(), [](NodeRun a, NodeRun b) { return a.begin < b.begin; });
  std::vector<std::uint32_t> moved_to(runs.size() + 1, 0);
  for (std::size_t i = 0; i < runs.size(); ++i) moved_to[i + 1] = moved_to[i] + runs[i].count;

  RawArray<BvhNode> dense(moved_to.back());
  parallel_for(executor, 0, runs.size(), 1, [&](std::size_t i) {
    const NodeRun run = runs[i];
    for (std::uint32_t k = 0; k < run.count; ++k) {
      BvhNode node = nodes[run.place + k];
      if (!node.is_leaf()) {
        // Children lie in the same run, or begin one.
        std::size_t of = i;
        if (node.first_index - run.begin >= run.count)
          of = static_cast<std::size_t>(
              std::lower_bound(runs.begin(), runs.end(), node.first_index,
                               [](NodeRun r, std::uint32_t begin) { return r.begin < begin; }) -
              runs.begin());
        node.first_index = moved_to[of] + (node.first_index - runs[of].begin);
      }
      dense[moved_to[i] + k] = node;
    }
  });
  return dense;
}

}  // namespace boxwood
