// every_tree.h: which trees must give the same answers?
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "boxwood/build/build.h"
#include "support/random_tree.h"

namespace boxwood::test {

struct NamedTree {
  std::string name;
  Bvh bvh;
};

/// Trees of every method at several leaf sizes, and random ones.
inline std::vector<NamedTree> every_tree(const std::vector<Box3>& boxes) {
  std::vector<NamedTree> trees;
  for (const auto& [method, name] :
       {std::pair{Method::longest_axis, "longest_axis"}, std::pair{Method::binned_sah, "binned_sah"},
        std::pair{Method::sweep_sah, "sweep_sah"}, std::pair{Method::ploc, "ploc"}})
    for (int leaf_size : {1, 4, 13}) {
      BuildOptions options;
      options.method = method;
      options.leaf_size = leaf_size;
      trees.push_back(
          {std::string(name) + ", leaf size " + std::to_string(leaf_size), build(boxes, options)});
    }
  for (std::uint64_t seed : {1, 2, 3}) trees.push_back({"random tree", random_tree(boxes, 3, seed)});
  return trees;
}

}  // namespace boxwood::test
