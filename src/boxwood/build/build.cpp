#include "boxwood/build/build.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

namespace boxwood {

BuildOptions BuildOptions::fast() { return {}; }
BuildOptions BuildOptions::balanced() { return {}; }
BuildOptions BuildOptions::best() { return {}; }

namespace {

void split(Bvh& bvh, std::span<const Box3> boxes, std::uint32_t node_index, std::uint32_t begin, std::uint32_t end) {
  Box3 box, centers;
  for (std::uint32_t i = begin; i < end; ++i) {
    box.extend(boxes[bvh.prim_ids[i].value]);
    centers.extend(boxes[bvh.prim_ids[i].value].center());
  }
  bvh.nodes[node_index] = {box, begin, end - begin};
  if (end - begin <= 4) return;
  const int axis = longest_axis(centers.extent());
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::sort(bvh.prim_ids.begin() + begin, bvh.prim_ids.begin() + end, [&](PrimId a, PrimId b) {
    const float ca = boxes[a.value].center()[axis], cb = boxes[b.value].center()[axis];
    return ca != cb ? ca < cb : a < b;
  });
  const auto left = static_cast<std::uint32_t>(bvh.nodes.size());
  bvh.nodes[node_index] = {box, left, 0};
  bvh.nodes.resize(left + 2);
  split(bvh, boxes, left, begin, middle);
  split(bvh, boxes, left + 1, middle, end);
}

}  // namespace

Bvh build(std::span<const Box3> boxes, const BuildOptions&) {
  Bvh bvh;
  if (boxes.empty()) return bvh;
  bvh.prim_ids.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) bvh.prim_ids[i] = PrimId(i);
  bvh.nodes.resize(1);
  split(bvh, boxes, 0, 0, static_cast<std::uint32_t>(boxes.size()));
  return bvh;
}

}  // namespace boxwood
