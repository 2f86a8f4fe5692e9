// classic_bvh.h: what was the BVH that this project grew from?
//
// The first version that most people write: nodes on the heap that share ownership of their children, a build
// that halves the longest axis, a recursive search. It is kept pointer by pointer, because it is the first
// rung of the ladder above brute force. What changed are its faults, and each mending is marked, M1 to M14.
//
// Left as they were, since they cost time and not truth: a chase of pointers, recursion, children in no
// order, and boxes that are opened though they begin behind the best hit. The next rungs take these away one
// by one.
//
// Invariant: a node holds shapes_[index, index + n_objs);
// sorting the pointers makes each subtree such a range.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "boxwood/reference/structure.h"

namespace boxwood::reference {

template <ShapeType Shape>
class ClassicBvh {
 public:
  /// Builds the tree. A node of `threshold` shapes or fewer, or at depth `max_depth`, is a leaf. Keeps
  /// pointers: the shapes must outlive the tree. Throws std::invalid_argument for a box that is not finite.
  void build(std::span<const Shape> shapes, std::uint32_t max_depth, std::uint32_t threshold) {
    // M1. Start afresh; the pseudocode appended to the shapes of an earlier build.
    given_ = shapes;
    shapes_.clear();
    root_ = nullptr;
    node_count_ = 0;

    std::vector<Box3> boxes;
    boxes.reserve(shapes.size());
    for (const Shape& shape : shapes) boxes.push_back(shape.box());
    bounds_ = checked_bounds(boxes);

    // M2. Leave out shapes with an empty box: they are never hit, and a center that is a NaN would spoil the
    // sort.
    for (std::size_t i = 0; i < shapes.size(); ++i)
      if (!boxes[i].is_empty()) shapes_.push_back(&shapes[i]);

    // M3. Make the root before it is used, and only when there is something to hold.
    if (shapes_.empty()) return;
    root_ = std::make_shared<Node>();
    build_recursive(boxes, 0, static_cast<std::uint32_t>(shapes_.size()), *root_, 0, max_depth, threshold);
  }

  /// Finds the closest hit; returns whether there is one.
  bool hit(const Ray& ray, ShapeHit& hit_info) const {
    // M4. Begin with an empty record: what it held before is not a hit of this ray.
    NoRivalStatistics none;
    hit_info = closest_hit(*this, given_, ray, none);
    return hit_info.is_hit();
  }

  Box3 bounds() const { return bounds_; }
  /// The nodes with the two counters and the type that a shared
  /// pointer keeps beside each, and the pointers to shapes.
  std::size_t size_bytes() const {
    return node_count_ * (sizeof(Node) + 2 * sizeof(int) + sizeof(void*)) +
           shapes_.size() * sizeof(const Shape*);
  }

  template <Query Q, class Statistics>
  void walk(const PreparedRay& ray, Q& query, Statistics& statistics) const {
    if (!root_) return;
    statistics.count_boxes(1);
    if (meets(ray, root_->box)) hit_recursive(ray, query, *root_, statistics);
  }

 private:
  struct Node {
    std::shared_ptr<Node> left_node, right_node;
    bool leaf = false;
    Box3 box;
    std::uint32_t index = 0, n_objs = 0;

    void make_leaf(std::uint32_t first, std::uint32_t count) {
      leaf = true;
      index = first;
      n_objs = count;
    }
  };

  void build_recursive(std::span<const Box3> boxes, std::uint32_t left_index, std::uint32_t right_index,
                       Node& node, std::uint32_t depth, std::uint32_t max_depth, std::uint32_t threshold) {
    // M5. Every node gets its box here; the pseudocode gave one to the root alone.
    ++node_count_;
    for (std::uint32_t i = left_index; i < right_index; ++i) node.box.extend(boxes[id_of(i).value]);

    // M6. Return from a leaf, where the pseudocode went on and split it as well.
    if (right_index - left_index <= threshold || depth >= max_depth)
      return node.make_leaf(left_index, right_index - left_index);

    // M7. "No index splits the range" is an index at its end, not a number that no unsigned variable can
    // hold.
    const std::uint32_t split_index = find_split_index(boxes, left_index, right_index, node.box);
    if (split_index == left_index || split_index == right_index)
      return node.make_leaf(left_index, right_index - left_index);
    node.left_node = std::make_shared<Node>();
    node.right_node = std::make_shared<Node>();
    build_recursive(boxes, left_index, split_index, *node.left_node, depth + 1, max_depth, threshold);
    build_recursive(boxes, split_index, right_index, *node.right_node, depth + 1, max_depth, threshold);
  }

  /// Sorts the range along the longest axis of `box` and returns
  /// the first shape whose center is not left of the middle.
  std::uint32_t find_split_index(std::span<const Box3> boxes, std::uint32_t left_index,
                                 std::uint32_t right_index, const Box3& box) {
    const int axis = longest_axis(box.extent());
    const float middle = box.center()[axis];
    const auto center = [&](const Shape* shape) { return boxes[id_of(shape).value].center()[axis]; };
    const auto begin = shapes_.begin() + left_index, end = shapes_.begin() + right_index;

    // M8. Equal centers keep the order of the ids, so that the tree is the same on every machine.
    std::sort(begin, end, [&](const Shape* a, const Shape* b) {
      const float ca = center(a), cb = center(b);
      return ca != cb ? ca < cb : a < b;
    });
    const auto split =
        std::partition_point(begin, end, [&](const Shape* shape) { return center(shape) < middle; });
    return static_cast<std::uint32_t>(split - shapes_.begin());
  }

  /// M9. Met means anywhere in [t_min, t_max]: from inside too, but not behind the origin.
  static bool meets(const PreparedRay& ray, const Box3& box) {
    const float entry = ray.bound(box);  // +inf for a box that is missed, and t_max may be +inf too
    return entry < kInfinity && entry <= ray.t_max;
  }

  // M10. The node comes by reference; a shared pointer by value counts up and down, atomically, at each call.
  // M11. One query, and in it the best hit so far, is passed down to every leaf. The pseudocode gave
  //      each call a new record: no leaf knew the best distance, an interior node wrote its
  //      children's hit over a nearer one of its caller, and the right child's hit was compared
  //      with a left one that nothing may have set.
  // M12. Nothing is returned. "There is something in the record"
  //      also held for an older hit;
  //      the caller at the root looks at the record itself.
  template <Query Q, class Statistics>
  void hit_recursive(const PreparedRay& ray, Q& query, const Node& node, Statistics& statistics) const {
    // M13. A shape that misses reports nothing, so it cannot leave its marks in the record of a
    //      hit; and of two hits at the same distance the smaller id is kept, whichever leaf came
    //      first. Both are the query's work.
    if (node.leaf) {
      for (std::uint32_t i = node.index; i < node.index + node.n_objs; ++i)
        visit(query, id_of(i), statistics);
      return;  // M14. A leaf without a hit went on to ask for children that it does not have.
    }
    statistics.count_boxes(2);
    if (meets(ray, node.left_node->box)) hit_recursive(ray, query, *node.left_node, statistics);
    if (query.limit() < ray.t_min) return;  // any hit is content with one
    if (meets(ray, node.right_node->box)) hit_recursive(ray, query, *node.right_node, statistics);
  }

  PrimId id_of(const Shape* shape) const { return PrimId(static_cast<std::uint64_t>(shape - given_.data())); }
  PrimId id_of(std::uint32_t i) const { return id_of(shapes_[i]); }

  std::span<const Shape> given_;
  std::vector<const Shape*> shapes_;
  std::shared_ptr<Node> root_;
  Box3 bounds_;
  std::size_t node_count_ = 0;
};

}  // namespace boxwood::reference
