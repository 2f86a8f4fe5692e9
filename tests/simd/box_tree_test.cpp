// box_tree_test.cpp: are all items visited whose boxes a ray enters, once each, and nearest boxes first?
#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/core/random.h"
#include "boxwood/simd/kernels.h"
#include "boxwood/tree/collapse.h"
#include "support/hard_rays.h"

namespace boxwood::simd {
namespace {

BoxTree pack(int width, const std::vector<Box3>& boxes) {
  const Bvh bvh = build(boxes);
  return with_width(width, [&](auto w) { return BoxTree(collapse<w()>(bvh, serial_executor()), boxes); });
}

/// What a visit does: notes the item, and lowers the limit as told.
struct Visits {
  std::vector<std::uint32_t> items;
  std::vector<float> limits;  // of each item; lowest of those visited counts
  float limit;

  static float visit(void* context, std::uint32_t item) {
    auto& self = *static_cast<Visits*>(context);
    self.items.push_back(item);
    self.limit = min(self.limit, self.limits[item]);
    return self.limit;
  }
};

std::vector<Box3> random_boxes(std::size_t count, Random& random) {
  std::vector<Box3> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 a = random.in_box({-1, -1, -1}, {1, 1, 1});
    boxes.push_back({a, a + random.in_box({0, 0, 0}, {0.2f, 0.2f, 0.2f}) * float(random.below(3))});
  }
  return boxes;
}

void expect_all_visited(const std::vector<Box3>& boxes) {
  Random random(5, boxes.size());
  Box3 bounds;
  for (const Box3& box : boxes) bounds.extend(box);
  for (const Kernels* kernels : available_kernels()) {
    const BoxTree tree = pack(kernels->width, boxes);
    ASSERT_TRUE(tree.is_ordinary());
    std::size_t entered = 0;
    for (int i = 0; i < 2000; ++i) {
      // Most are aimed at a box, others go anywhere or along an axis.
      const Vec3 origin = random.in_box({-2, -2, -2}, {2, 2, 2});
      const Box3& aim = boxes[random.below(static_cast<std::uint32_t>(boxes.size()))];
      const Vec3 direction = i % 8 == 0   ? Vec3{0, i % 16 ? -1.0f : 1.0f, 0}
                             : i % 8 == 1 ? random.direction()
                                          : random.in_box(aim.lower, aim.upper) - origin;
      const Ray ray{origin, random.uniform() - 0.5f, direction, i % 3 ? kInfinity : 1.5f};
      const PreparedRay prepared(ray, bounds);
      Visits visits{{}, std::vector<float>(boxes.size(), kInfinity), ray.t_max};
      ASSERT_TRUE(kernels->visit_boxes(tree, ray, bounds, Visits::visit, &visits));
      std::vector<std::uint32_t> sorted = visits.items;
      std::sort(sorted.begin(), sorted.end());
      ASSERT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end()) << "twice";
      for (std::uint32_t item = 0; item < boxes.size(); ++item) {
        const Interval inside = prepared.interval(boxes[item]);
        if (inside.is_empty() || !(max(inside.entry, prepared.t_min) <= min(inside.exit, ray.t_max)))
          continue;
        ++entered;
        ASSERT_TRUE(std::binary_search(sorted.begin(), sorted.end(), item)) << kernels->name;
      }
    }
    EXPECT_GT(entered, 500u);
  }
}

TEST(BoxTree, EveryItemThatARayEntersIsVisitedOnce) {
  Random random(1);
  for (const std::size_t count : {1, 2, 5, 13, 100, 3000}) {
    SCOPED_TRACE(count);
    expect_all_visited(random_boxes(count, random));
  }
}

TEST(BoxTree, ManyItemsMayShareABox) {
  Random random(2);
  std::vector<Box3> boxes = random_boxes(3, random);
  for (int i = 0; i < 100; ++i) boxes.push_back({{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}});
  expect_all_visited(boxes);
}

TEST(BoxTree, WhatLiesBehindTheLimitIsLeftOut) {
  // A row of boxes, of which the third says that nothing behind it matters.
  std::vector<Box3> boxes;
  Box3 bounds;
  for (int i = 0; i < 64; ++i) {
    boxes.push_back({{float(i), 0, 0}, {float(i) + 0.5f, 1, 1}});
    bounds.extend(boxes.back());
  }
  for (const Kernels* kernels : available_kernels()) {
    const BoxTree tree = pack(kernels->width, boxes);
    Visits visits{{}, std::vector<float>(boxes.size(), kInfinity), kInfinity};
    visits.limits[2] = 4;  // seen from x = -1
    ASSERT_TRUE(kernels->visit_boxes(tree, {{-1, 0.5f, 0.5f}, 0, {1, 0, 0}}, bounds, Visits::visit, &visits));
    EXPECT_EQ(visits.items, (std::vector<std::uint32_t>{0, 1, 2, 3})) << kernels->name;

    // Nothing at all, once one said so.
    visits = {{}, std::vector<float>(boxes.size(), -kInfinity), kInfinity};
    ASSERT_TRUE(kernels->visit_boxes(tree, {{-1, 0.5f, 0.5f}, 0, {1, 0, 0}}, bounds, Visits::visit, &visits));
    EXPECT_EQ(visits.items.size(), 1u);
  }
}

TEST(BoxTree, EmptyBoxesAreNoItemsAndOddRaysAreHandedBack) {
  std::vector<Box3> boxes(3);
  boxes[1] = {{0, 0, 0}, {1, 1, 1}};
  for (const Kernels* kernels : available_kernels()) {
    const BoxTree tree = pack(kernels->width, boxes);
    Visits visits{{}, std::vector<float>(boxes.size(), kInfinity), kInfinity};
    ASSERT_TRUE(
        kernels->visit_boxes(tree, {{0.5f, 0.5f, -1}, 0, {0, 0, 1}}, boxes[1], Visits::visit, &visits));
    EXPECT_EQ(visits.items, (std::vector<std::uint32_t>{1}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(kernels->visit_boxes(tree, {{nan, 0, 0}, 0, {0, 0, 1}}, boxes[1], Visits::visit, &visits));
    EXPECT_FALSE(kernels->visit_boxes(tree, {{0, 0, 0}, 0, {0, 0, 0}}, boxes[1], Visits::visit, &visits));
    EXPECT_EQ(visits.items.size(), 1u);
    EXPECT_TRUE(pack(kernels->width, {}).is_empty());
  }
}

}  // namespace
}  // namespace boxwood::simd
