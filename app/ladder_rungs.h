// ladder_rungs.h: which structures are the rungs, from the bottom to the top?
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "boxwood/build/build.h"
#include "boxwood/reference/classic_bvh.h"
#include "boxwood/reference/flat_bvh.h"
#include "boxwood/reference/kd_tree.h"
#include "boxwood/reference/octree.h"
#include "boxwood/reference/uniform_grid.h"
#include "rung.h"
#include "upper_rungs.h"

namespace boxwood::app {

/// How to stand on a rung.
template <ShapeType S>
struct RungRecipe {
  std::string name;
  std::function<std::unique_ptr<Rung<S>>(std::span<const S>)> build;
};

/// The first is brute force. The kernels' rungs are there for triangles, on a machine that has kernels.
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

  std::vector<RungRecipe<S>> recipes{
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
      {"wide tree",
       [](Shapes shapes) -> std::unique_ptr<Rung<S>> {
         return std::make_unique<StructureRung<S, WideTree>>(shapes, wide_tree(boxes(shapes)));
       }},
      {"kd-tree", space_splitting(std::type_identity<KdTree>{})},
      {"octree", space_splitting(std::type_identity<Octree>{})},
      {"uniform grid", space_splitting(std::type_identity<UniformGrid>{})},
  };
  if constexpr (std::is_same_v<S, Triangle>) {
    const auto scene = [](bool in_batches) {
      return [in_batches](Shapes shapes) -> std::unique_ptr<Rung<S>> {
        return std::make_unique<SceneRung>(shapes, in_batches);
      };
    };
    const auto wide = std::find_if(recipes.begin(), recipes.end(),
                                   [](const RungRecipe<S>& recipe) { return recipe.name == "wide tree"; });
    if (simd::kernels())
      recipes.insert(wide + 1, {{"SIMD kernel", scene(false)}, {"SIMD kernel, batch", scene(true)}});
  }
  return recipes;
}

}  // namespace boxwood::app
