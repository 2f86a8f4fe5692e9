// flat_bvh.h: what does the array bring, and what the order of the children?
//
// Two walks over the library's flat tree (tree/bvh.h), as structures of this room. UnorderedBvh does just
// what ClassicBvh does, without pointers and recursion: left child first, every box that the ray meets is
// opened. OrderedBvh is the library's own loop: nearer child first, and no box that begins behind the best
// hit.
#pragma once

#include "boxwood/query/traverse.h"
#include "boxwood/reference/structure.h"

namespace boxwood::reference {

/// Keeps a pointer: the tree must outlive it.
class UnorderedBvh {
 public:
  explicit UnorderedBvh(const Bvh& bvh) : bvh_(&bvh) {}

  Box3 bounds() const { return bvh_->bounds(); }
  std::size_t size_bytes() const { return bvh_->size_bytes(); }

  template <Query Q, class Statistics>
  void walk(const PreparedRay& ray, Q& query, Statistics& statistics) const {
    if (bvh_->is_empty()) return;
    const auto meets = [&](std::uint32_t node_index) {
      const float entry = ray.bound(bvh_->nodes[node_index].box);  // +inf for a box that is missed
      return entry < kInfinity && entry <= ray.t_max;
    };
    std::uint32_t stack[kMaxDepth + 2];
    int waiting = 0;
    statistics.count_boxes(1);
    if (meets(0)) stack[waiting++] = 0;

    while (waiting > 0) {
      const BvhNode& node = bvh_->nodes[stack[--waiting]];
      if (node.is_leaf()) {
        for (std::uint32_t i = 0; i < node.count; ++i)
          visit(query, bvh_->prim_ids[node.first_index + i], statistics);
        if (query.limit() < ray.t_min) return;  // any hit is content with one
        continue;
      }
      // Put the left child on top.
      statistics.count_boxes(2);
      if (meets(node.first_index + 1)) stack[waiting++] = node.first_index + 1;
      if (meets(node.first_index)) stack[waiting++] = node.first_index;
    }
  }

 private:
  const Bvh* bvh_;
};

/// Keeps a pointer: the tree must outlive it.
class OrderedBvh {
 public:
  explicit OrderedBvh(const Bvh& bvh) : bvh_(&bvh) {}

  Box3 bounds() const { return bvh_->bounds(); }
  std::size_t size_bytes() const { return bvh_->size_bytes(); }

  template <Query Q, class Statistics>
  void walk(const PreparedRay&, Q& query, Statistics& statistics) const {
    // Stand between the loop and the query to learn which shapes are tested.
    struct Counted {
      Q& query;
      Statistics& statistics;
      float bound(const Box3& box) const { return query.bound(box); }
      float limit() const { return query.limit(); }
      void visit(PrimId id) { reference::visit(query, id, statistics); }
    } counted{query, statistics};
    struct BoxesOnly {
      Statistics& statistics;
      void count_boxes(int n) { statistics.count_boxes(n); }
      void count_shapes(std::uint32_t) {}
    } boxes_only{statistics};
    traverse(*bvh_, counted, boxes_only);
  }

 private:
  const Bvh* bvh_;
};

}  // namespace boxwood::reference
