// ladder_rungs.h: which structures are the rungs, from the bottom to the top?
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "boxwood/build/build.h"
#include "boxwood/reference/brute_force.h"
#include "boxwood/reference/classic_bvh.h"
#include "boxwood/reference/flat_bvh.h"
#include "boxwood/reference/kd_tree.h"
#include "boxwood/reference/octree.h"
#include "boxwood/reference/uniform_grid.h"

namespace boxwood::app {

/// A structure that stands over `shapes`, as the measurements see it: a whole batch for each call, so that no
/// rung pays for being called through a pointer.
template <ShapeType S>
class Rung {
 public:
  virtual ~Rung() = default;
  virtual void trace(std::span<const Ray> rays, std::span<ShapeHit> hits) const = 0;
  virtual void count(std::span<const Ray> rays, reference::RivalStatistics& statistics) const = 0;
  virtual std::size_t size_bytes() const = 0;
};

/// The judge. It tests every shape, and counts them by that.
template <ShapeType S>
class BruteForceRung final : public Rung<S> {
 public:
  explicit BruteForceRung(std::span<const S> shapes) : shapes_(shapes), brute_force_(shapes) {}
  void trace(std::span<const Ray> rays, std::span<ShapeHit> hits) const override {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = brute_force_.closest_hit(rays[i]);
  }
  void count(std::span<const Ray> rays, reference::RivalStatistics& statistics) const override {
    statistics.shape_tests += rays.size() * shapes_.size();
  }
  std::size_t size_bytes() const override { return brute_force_.size_bytes(); }

 private:
  std::span<const S> shapes_;
  reference::BruteForce<S> brute_force_;
};

/// Any structure of reference/, with what must live as long as it does.
template <ShapeType S, reference::Structure T>
class StructureRung final : public Rung<S> {
 public:
  StructureRung(std::span<const S> shapes, T structure, std::shared_ptr<const Bvh> tree = nullptr)
      : shapes_(shapes), structure_(std::move(structure)), tree_(std::move(tree)) {}
  void trace(std::span<const Ray> rays, std::span<ShapeHit> hits) const override {
    reference::NoRivalStatistics none;
    for (std::size_t i = 0; i < rays.size(); ++i)
      hits[i] = reference::closest_hit(structure_, shapes_, rays[i], none);
  }
  void count(std::span<const Ray> rays, reference::RivalStatistics& statistics) const override {
    for (const Ray& ray : rays) (void)reference::closest_hit(structure_, shapes_, ray, statistics);
  }
  std::size_t size_bytes() const override { return structure_.size_bytes(); }

 private:
  std::span<const S> shapes_;
  T structure_;
  std::shared_ptr<const Bvh> tree_;
};

/// How to stand on a rung.
template <ShapeType S>
struct RungRecipe {
  std::string name;
  std::function<std::unique_ptr<Rung<S>>(std::span<const S>)> build;
};

/// The first is brute force.
template <ShapeType S>
std::vector<RungRecipe<S>> rung_recipes() {
  using namespace reference;
  using Shapes = std::span<const S>;

  // The seed's own tree, its flat twin, and the two walks over the latter share these numbers.
  constexpr int kDepth = 64, kLeafSize = 4;
  const auto tree = [](Shapes shapes, Method method) {
    return std::make_shared<const Bvh>(build(
        boxes(shapes),
        {.method = method, .max_depth = kDepth, .leaf_size = kLeafSize, .executor = &serial_executor()}));
  };
  const auto ordered = [tree](Method method) {
    return [tree, method](Shapes shapes) -> std::unique_ptr<Rung<S>> {
      auto bvh = tree(shapes, method);
      return std::make_unique<StructureRung<S, OrderedBvh>>(shapes, OrderedBvh(*bvh), bvh);
    };
  };
  const auto space_splitting = []<class T>(std::type_identity<T>) {
    return [](Shapes shapes) -> std::unique_ptr<Rung<S>> {
      return std::make_unique<StructureRung<S, T>>(shapes, T(boxes(shapes)));
    };
  };

  return {
      {"brute force",
       [](Shapes shapes) -> std::unique_ptr<Rung<S>> { return std::make_unique<BruteForceRung<S>>(shapes); }},
      {"seed BVH",
       [](Shapes shapes) -> std::unique_ptr<Rung<S>> {
         ClassicBvh<S> classic;
         classic.build(shapes, kDepth, kLeafSize);
         return std::make_unique<StructureRung<S, ClassicBvh<S>>>(shapes, std::move(classic));
       }},
      {"flat, no recursion",
       [tree](Shapes shapes) -> std::unique_ptr<Rung<S>> {
         auto bvh = tree(shapes, Method::longest_axis);
         return std::make_unique<StructureRung<S, UnorderedBvh>>(shapes, UnorderedBvh(*bvh), bvh);
       }},
      {"nearer child first", ordered(Method::longest_axis)},
      {"binned SAH", ordered(Method::binned_sah)},
      {"sweep SAH", ordered(Method::sweep_sah)},
      {"kd-tree", space_splitting(std::type_identity<KdTree>{})},
      {"octree", space_splitting(std::type_identity<Octree>{})},
      {"uniform grid", space_splitting(std::type_identity<UniformGrid>{})},
  };
}

}  // namespace boxwood::app
