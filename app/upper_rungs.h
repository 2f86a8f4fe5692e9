// upper_rungs.h: which rungs lie above the best binary tree?
//
// The wide tree asks all children of a node at once, still in plain C++ and for shapes of any kind. For
// triangles a scene's kernels follow, on a tree as wide as their vectors, each node and block in one go; one
// ray after the other, and then a whole batch, whose rays take turns.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "boxwood/build/build.h"
#include "boxwood/query/traverse_wide.h"
#include "boxwood/scene/scene.h"
#include "boxwood/simd/kernels.h"
#include "boxwood/tree/collapse.h"
#include "rung.h"

namespace boxwood::app {

/// The walk over eight children a node, as a structure of reference/.
class WideTree {
 public:
  explicit WideTree(const Bvh& bvh) : wide_(collapse<8>(bvh, serial_executor())) {}

  Box3 bounds() const { return wide_.box; }
  std::size_t size_bytes() const { return wide_.size_bytes(); }

  template <Query Q, class Statistics>
  void walk(const PreparedRay&, Q& query, Statistics& statistics) const {
    if (wide_.is_empty()) return;
    // Show the query each primitive of a leaf; what only fills a block is none.
    struct Leaves {
      std::span<const PrimId> slots;
      Q& query;
      Statistics& statistics;
      float bound(const Box3& box) const { return query.bound(box); }
      float limit() const { return query.limit(); }
      void visit(ChildRef leaf) {
        for (std::uint32_t b = 0; b < leaf.blocks(); ++b) {
          const PrimId* block = &slots[std::size_t(leaf.index() + b) * kBlockWidth];
          for (int lane = 0; lane < kBlockWidth; ++lane)
            if (!is_padding(block, lane)) reference::visit(query, block[lane], statistics);
        }
      }
    } leaves{wide_.slots, query, statistics};
    traverse_wide<8>(
        [&](ChildRef node) -> const auto& { return wide_.nodes[node.index()]; }, leaves, statistics);
  }

 private:
  WideBvh<8> wide_;
};

/// Built as a scene builds its trees.
inline BuildOptions upper_options() {
  BuildOptions options = BuildOptions::balanced();
  options.executor = &serial_executor();
  return options;
}

inline WideTree wide_tree(std::span<const Box3> boxes) {
  BuildOptions options = upper_options();
  options.block_size = kBlockWidth;
  return WideTree(build(boxes, options));
}

/// One mesh of separate triangles, in the order of `triangles`, as a scene on one thread.
inline Scene scene_of(std::span<const Triangle> triangles) {
  TriangleMesh mesh;
  mesh.positions.reserve(3 * triangles.size());
  mesh.indices.reserve(triangles.size());
  for (const Triangle& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {triangle.a, triangle.b, triangle.c});
    mesh.indices.push_back({first, first + 1, first + 2});
  }
  SceneDesc desc;
  desc.add(std::move(mesh));
  return Scene(std::move(desc), upper_options());
}

/// What a scene's answer says about the shape; the instance and the geometry are the only ones.
inline ShapeHit shape_hit(const Hit& hit) {
  return {{hit.t, hit.u, hit.v, hit.part}, hit.primitive_id};
}

/// Triangles in a scene, asked ray by ray or in batches.
class SceneRung final : public Rung<Triangle> {
 public:
  SceneRung(std::span<const Triangle> triangles, bool in_batches)
      : scene_(scene_of(triangles)), in_batches_(in_batches) {}

  void trace(std::span<const Ray> rays, std::span<ShapeHit> hits) const override {
    if (!in_batches_) {
      for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = shape_hit(scene_.closest_hit(rays[i]));
      return;
    }
    // As many at a time as stay in the cache until they are copied.
    constexpr std::size_t kAtOnce = 4096;
    std::vector<Hit> found(std::min(rays.size(), kAtOnce));
    for (std::size_t begin = 0; begin < rays.size(); begin += kAtOnce) {
      const std::size_t count = std::min(kAtOnce, rays.size() - begin);
      scene_.closest_hit(rays.subspan(begin, count), std::span(found).first(count), &serial_executor());
      std::transform(found.begin(), found.begin() + std::ptrdiff_t(count),
                     hits.begin() + std::ptrdiff_t(begin), shape_hit);
    }
  }
  /// Kernels do not count; plain C++ does, on the way through the same tree. No triangle stands there twice.
  void count(std::span<const Ray> rays, reference::RivalStatistics& statistics) const override {
    TraversalStatistics work;
    for (const Ray& ray : rays) (void)scene_.closest_hit(ray, work);
    statistics.box_tests += work.box_tests;
    statistics.shape_tests += work.shape_tests;
  }
  std::size_t size_bytes() const override {
    const SceneStatistics statistics = scene_.statistics();
    return statistics.tree_bytes + statistics.geometry_bytes;
  }

 private:
  Scene scene_;
  bool in_batches_;
};

}  // namespace boxwood::app
