// Every builder, on every set of boxes, makes a legal tree, and always the same one.
#include "boxwood/build/build.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstring>

#include <gtest/gtest.h>

#include "boxwood/core/error.h"
#include "boxwood/tree/metrics.h"
#include "boxwood/tree/validate.h"
#include "support/box_sets.h"

namespace boxwood {
namespace {

using test::box_sets;
using test::BoxSet;
using test::soup_boxes;
using test::terrain_boxes;

constexpr Method kMethods[] = {Method::longest_axis, Method::binned_sah, Method::sweep_sah, Method::ploc};

std::string name(Method method) {
  return method == Method::longest_axis ? "longest_axis"
         : method == Method::binned_sah ? "binned_sah"
         : method == Method::sweep_sah  ? "sweep_sah"
                                        : "ploc";
}

/// Equal in every bit, which is more than ==: that takes -0 for +0.
bool same_bits(const Bvh& a, const Bvh& b) {
  return a.nodes.size() == b.nodes.size() && a.prim_ids == b.prim_ids &&
         (a.nodes.empty() ||
          std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BvhNode)) == 0);
}

class EachMethod : public ::testing::TestWithParam<Method> {
 protected:
  BuildOptions options() const { return {.method = GetParam()}; }
};
INSTANTIATE_TEST_SUITE_P(Build, EachMethod, ::testing::ValuesIn(kMethods),
                         [](const auto& test) { return name(test.param); });

TEST_P(EachMethod, MakesALegalTreeOfEverySet) {
  for (const BoxSet& set : box_sets())
    for (const int leaf_size : {1, 4, 13})
      for (const int max_depth : {0, 1, 5, 20, 64, kMaxDepth}) {
        BuildOptions o = options();
        o.leaf_size = leaf_size;
        o.max_depth = max_depth;
        o.executor = &serial_executor();
        const Bvh bvh = build(set.boxes, o);
        ASSERT_EQ(validate(bvh, set.boxes), "")
            << set.name << ", leaf_size " << leaf_size << ", max_depth " << max_depth;
        ASSERT_LE(tree_shape(bvh).depth, max_depth) << set.name << ", leaf_size " << leaf_size;
      }
}

TEST_P(EachMethod, BoxesAreTight) {
  for (const BoxSet& set : box_sets()) {
    const Bvh bvh = build(set.boxes, options());
    Box3 all;
    for (const Box3& box : set.boxes)
      if (!box.is_empty()) all.extend(box);
    EXPECT_EQ(bvh.bounds(), all) << set.name;
    for (const BvhNode& node : bvh.nodes) {
      Box3 inside;
      if (node.is_leaf())
        for (std::uint32_t i = 0; i < node.count; ++i)
          inside.extend(set.boxes[bvh.prim_ids[node.first_index + i].value]);
      else
        inside = unite(bvh.nodes[node.first_index].box, bvh.nodes[node.first_index + 1].box);
      ASSERT_EQ(node.box, inside) << set.name;
    }
  }
}

TEST_P(EachMethod, MakesTheSameTreeForAnyNumberOfThreads) {
  std::vector<BoxSet> sets = box_sets();
  sets.push_back({"large soup", soup_boxes(200'000)});
  sets.push_back({"large terrain", terrain_boxes(250)});
  sets.push_back({"large coincident", std::vector<Box3>(50'000, Box3{{0, 0, 0}, {1, 1, 1}})});
  const auto two = make_executor(2), eight = make_executor(8);
  for (const BoxSet& set : sets) {
    BuildOptions o = options();
    o.executor = &serial_executor();
    const Bvh serial = build(set.boxes, o);
    for (Executor* executor : {two.get(), eight.get(), &default_executor()}) {
      o.executor = executor;
      EXPECT_TRUE(same_bits(build(set.boxes, o), serial))
          << set.name << ", " << executor->concurrency() << " threads";
    }
  }
}

TEST_P(EachMethod, NodesLieInDepthFirstOrder) {
  const std::vector<Box3> boxes = soup_boxes(30'000);
  const Bvh bvh = build(boxes, options());
  // The pair of children, then all below the left one, then all below the right one.
  std::uint32_t next = 1;
  std::vector<std::uint32_t> waiting{0};
  while (!waiting.empty()) {
    const BvhNode& node = bvh.nodes[waiting.back()];
    waiting.pop_back();
    if (node.is_leaf()) continue;
    ASSERT_EQ(node.first_index, next);
    next += 2;
    waiting.insert(waiting.end(), {node.first_index + 1, node.first_index});
  }
  EXPECT_EQ(next, bvh.nodes.size());
}

TEST_P(EachMethod, ManyCoincidentBoxesAreQuick) {
  const std::vector<Box3> boxes(100'000, Box3{{1, 2, 3}, {2, 3, 4}});
  const auto start = std::chrono::steady_clock::now();
  const Bvh bvh = build(boxes, options());
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  EXPECT_EQ(validate(bvh, boxes), "");
  if (GetParam() == Method::longest_axis) {
    EXPECT_EQ(bvh.nodes.size(), 1u);  // no index splits them, so they are one leaf
  } else {
    EXPECT_LE(tree_shape(bvh).max_leaf_size, 4u);
  }
}

TEST(Build, LeavesOfTheHeuristicsAreBounded) {
  for (const Method method : {Method::binned_sah, Method::sweep_sah})
    for (const BoxSet& set : box_sets())
      for (const int leaf_size : {1, 2, 7}) {
        BuildOptions o{.method = method, .leaf_size = leaf_size};
        EXPECT_LE(tree_shape(build(set.boxes, o)).max_leaf_size, std::uint32_t(leaf_size)) << set.name;

        // As few levels as can hold them: the depth limit leads to halving, never to a large leaf.
        if (std::any_of(set.boxes.begin(), set.boxes.end(), [](const Box3& box) { return box.is_empty(); }))
          continue;
        o.max_depth = 0;
        while ((std::size_t(leaf_size) << o.max_depth) < set.boxes.size()) ++o.max_depth;
        EXPECT_LE(tree_shape(build(set.boxes, o)).max_leaf_size, std::uint32_t(leaf_size))
            << set.name << ", short of levels";
      }
}

TEST(Build, BlocksOfPrimitivesAreFilled) {
  for (const Method method : {Method::binned_sah, Method::sweep_sah})
    for (const BoxSet& set : {BoxSet{"soup", soup_boxes(30'000)}, BoxSet{"terrain", terrain_boxes(120)}}) {
      const Bvh one = build(set.boxes, {.method = method});
      const Bvh four = build(set.boxes, {.method = method, .block_size = 4});
      EXPECT_EQ(validate(four, set.boxes), "");
      // Nothing is gained by taking apart what is tested at once.
      EXPECT_GT(tree_shape(four).mean_leaf_size, 3) << set.name;
      EXPECT_GT(tree_shape(four).mean_leaf_size, 1.2 * tree_shape(one).mean_leaf_size) << set.name;
      EXPECT_EQ(tree_shape(four).max_leaf_size, 4u) << set.name;
    }
}

TEST_P(EachMethod, EmptyBoxesStandApart) {
  std::vector<Box3> boxes = soup_boxes(1000);
  for (std::size_t i = 500; i < 1000; ++i) boxes[i] = Box3{};
  const Bvh bvh = build(boxes, options());
  ASSERT_FALSE(bvh.nodes[0].is_leaf());
  EXPECT_TRUE(bvh.nodes[2].box.is_empty());
  // No box that a ray can enter leads to an empty one, but the root.
  for (const BvhNode& node : bvh.nodes)
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const Box3& box = boxes[bvh.prim_ids[node.first_index + i].value];
      EXPECT_EQ(box.is_empty(), node.box.is_empty());
    }
}

TEST_P(EachMethod, RefusesWhatIsOutOfRange) {
  const std::vector<Box3> boxes = soup_boxes(10);
  const auto message = [&](BuildOptions o, std::span<const Box3> from) -> std::string {
    try {
      build(from, o);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  const auto expect_named = [&](const std::string& what, BuildOptions o) {
    EXPECT_NE(message(o, boxes).find(what), std::string::npos) << message(o, boxes);
  };
  BuildOptions o = options();
  o.max_depth = -1, expect_named("max_depth is -1", o);
  o.max_depth = kMaxDepth + 1, expect_named("max_depth is 97", o);
  o = options();
  o.leaf_size = 0, expect_named("leaf_size is 0", o);
  o = options();
  o.block_size = 0, expect_named("block_size is 0", o);
  o = options();
  o.bins = 1, expect_named("bins is 1", o);
  o.bins = 65, expect_named("bins is 65", o);
  o = options();
  o.traversal_cost = -1, expect_named("traversal_cost", o);
  o.traversal_cost = std::nanf(""), expect_named("traversal_cost", o);
  o.traversal_cost = kInfinity, expect_named("traversal_cost", o);
  o = options();
  o.method = Method(17), expect_named("method is 17", o);

  // The first bad box is named, whoever finds one first.
  std::vector<Box3> bad = soup_boxes(100'000);
  bad[90'000].upper.y = std::nanf("");
  bad[70'001].lower.x = -kInfinity;
  bad[70'002].lower.x = std::nanf("");
  EXPECT_NE(message(options(), bad).find("box 70001 "), std::string::npos) << message(options(), bad);
  bad = soup_boxes(10);
  bad[3].upper.z = kInfinity;
  EXPECT_NE(message(options(), bad).find("box 3 "), std::string::npos);
  bad[3] = {splat(std::nanf("")), splat(std::nanf(""))};
  EXPECT_NE(message(options(), bad).find("box 3 "), std::string::npos);

  // Too many: the count is looked at before any box.
  EXPECT_NE(message(options(), std::span(boxes.data(), kMaxPrimitives)).find("2147483648"),
            std::string::npos);
}

TEST_P(EachMethod, TellsItsProgress) {
  const std::vector<Box3> boxes = soup_boxes(50'000);
  for (Executor* executor : {&serial_executor(), &default_executor()}) {
    double last = 0;
    int calls = 0;
    std::atomic<int> inside{0};
    BuildOptions o = options();
    o.executor = executor;
    o.progress = [&](std::string_view stage, double done) {
      EXPECT_EQ(++inside, 1) << "two threads at a time";
      EXPECT_EQ(stage, "build");
      EXPECT_GE(done, last);
      EXPECT_LE(done, 1);
      last = done;
      ++calls;
      --inside;
      return true;
    };
    const Bvh bvh = build(boxes, o);
    EXPECT_EQ(last, 1);
    EXPECT_GT(calls, 3);
    o.progress = nullptr;
    EXPECT_TRUE(same_bits(bvh, build(boxes, o)));
  }
}

TEST_P(EachMethod, StopsWhenAskedTo) {
  const std::vector<Box3> boxes = soup_boxes(50'000);
  for (Executor* executor : {&serial_executor(), &default_executor()})
    for (const double stop_at : {0.0, 0.3, 1.0}) {
      BuildOptions o = options();
      o.executor = executor;
      o.progress = [&](std::string_view, double done) { return done < stop_at; };
      EXPECT_THROW(build(boxes, o), Cancelled) << stop_at;
    }
}

TEST(Build, PresetsAreValid) {
  const std::vector<Box3> boxes = soup_boxes(20'000);
  for (const BuildOptions& o : {BuildOptions::fast(), BuildOptions::balanced(), BuildOptions::best()})
    EXPECT_EQ(validate(build(boxes, o), boxes), "");
  EXPECT_LE(sah_cost(build(boxes, BuildOptions::best())),
            sah_cost(build(boxes, BuildOptions::balanced())) * 1.001);
  EXPECT_LE(sah_cost(build(boxes, BuildOptions::balanced())),
            sah_cost(build(boxes, BuildOptions::fast())) * 1.001);
}

TEST(Build, TheHeuristicPays) {
  for (const BoxSet& set : {BoxSet{"soup", soup_boxes(50'000)}, BoxSet{"terrain", terrain_boxes(150)},
                            BoxSet{"long soup", soup_boxes(50'000, 3, 0.5f)}}) {
    const double longest = sah_cost(build(set.boxes, {.method = Method::longest_axis}));
    const double binned = sah_cost(build(set.boxes, {.method = Method::binned_sah}));
    const double sweep = sah_cost(build(set.boxes, {.method = Method::sweep_sah}));
    EXPECT_LE(sweep, binned * 1.05) << set.name;
    EXPECT_LE(binned, sweep * 1.1) << set.name;
    EXPECT_LT(binned, longest * 0.95) << set.name;
    EXPECT_LT(sweep, longest * 0.95) << set.name;
  }
}

TEST(Build, ClusteringIsWorthATree) {
  for (const BoxSet& set : {BoxSet{"soup", soup_boxes(50'000)}, BoxSet{"terrain", terrain_boxes(150)},
                            BoxSet{"long soup", soup_boxes(50'000, 3, 0.5f)}}) {
    const double sweep = sah_cost(build(set.boxes, {.method = Method::sweep_sah}));
    EXPECT_LE(sah_cost(build(set.boxes, {.method = Method::ploc})), sweep * 1.2) << set.name;
  }
}

TEST(Build, ClusteringPairsUpARow) {
  // Equal boxes at equal distances: if each chose the one before it, one pair a round would merge.
  std::vector<Box3> boxes;
  for (int i = 0; i < 4096; ++i) boxes.push_back({{float(i), 0, 0}, {float(i) + 0.5f, 1, 1}});
  EXPECT_LE(tree_shape(build(boxes, {.method = Method::ploc, .leaf_size = 1})).depth, 16);
}

/// The middle of what reinsertion changes: interior nodes.
double interior_area(const Bvh& bvh) {
  double area = 0;
  for (const BvhNode& node : bvh.nodes)
    if (!node.is_leaf()) area += half_area(node.box);
  return area;
}

TEST(Reinsertion, KeepsEveryTreeLegal) {
  for (const Method method : kMethods)
    for (const BoxSet& set : box_sets())
      for (const int max_depth : {5, 12, kMaxDepth}) {
        BuildOptions o{.method = method, .max_depth = max_depth, .leaf_size = 2};
        o.reinsertion_rounds = 6;
        o.reinsertion_share = 1;
        const Bvh bvh = build(set.boxes, o);
        ASSERT_EQ(validate(bvh, set.boxes), "") << set.name << ", " << name(method);
        ASSERT_LE(tree_shape(bvh).depth, max_depth) << set.name << ", " << name(method);
      }
}

TEST(Reinsertion, ATreeThatWouldBeTooDeepStaysAsItWas) {
  const std::vector<Box3> boxes = soup_boxes(4096, 3, 0.5f);
  BuildOptions o{.method = Method::binned_sah, .max_depth = 12, .leaf_size = 1};
  const Bvh plain = build(boxes, o);
  ASSERT_EQ(tree_shape(plain).depth, 12);
  o.reinsertion_rounds = 3;
  o.reinsertion_share = 1;
  EXPECT_TRUE(same_bits(build(boxes, o), plain));
}

TEST(Reinsertion, Pays) {
  const std::vector<Box3> boxes = soup_boxes(20'000, 3, 0.5f);
  BuildOptions o;
  const double before = interior_area(build(boxes, o));
  o.reinsertion_rounds = 4;
  o.reinsertion_share = 0.1f;
  EXPECT_LT(interior_area(build(boxes, o)), 0.97 * before);
}

TEST(Reinsertion, IsTheSameForAnyNumberOfThreads) {
  const std::vector<Box3> boxes = soup_boxes(60'000, 3, 0.2f);
  const auto two = make_executor(2), eight = make_executor(8);
  BuildOptions o = BuildOptions::best();
  o.executor = &serial_executor();
  const Bvh serial = build(boxes, o);
  for (Executor* executor : {two.get(), eight.get()}) {
    o.executor = executor;
    EXPECT_TRUE(same_bits(build(boxes, o), serial));
  }
}

TEST(Reinsertion, TellsItsProgressAndStops) {
  const std::vector<Box3> boxes = soup_boxes(50'000, 3, 0.5f);
  BuildOptions o = BuildOptions::best();
  o.executor = &serial_executor();
  double last = 0;
  int late = 0;
  o.progress = [&](std::string_view, double done) {
    EXPECT_GE(done, last);
    late += last >= 0.75 && done < 1;
    last = done;
    return true;
  };
  build(boxes, o);
  EXPECT_EQ(last, 1);
  EXPECT_GT(late, 3);
  o.progress = [&](std::string_view, double done) { return done < 0.9; };
  EXPECT_THROW(build(boxes, o), Cancelled);
}

TEST(Build, BoxesOfShapes) {
  struct Ball {
    float radius;
    Box3 box() const { return {splat(-radius), splat(radius)}; }
  };
  const std::vector<Box3> found = boxes(std::vector<Ball>{{1}, {2}});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1], (Box3{{-2, -2, -2}, {2, 2, 2}}));
}

}  // namespace
}  // namespace boxwood
