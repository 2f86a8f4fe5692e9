// closest_point_test.cpp: is the nearest point of every kernel that of brute force, to the bit?
//
// On trees of every builder, in both layouts, for points where it is hard: on vertices, edges and faces, as
// near to one triangle as to another, far away, and with limits at the very distance.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "boxwood/query/distance.h"
#include "boxwood/tree/collapse.h"
#include "kernel_oracle.h"
#include "support/meshes.h"
#include "support/shapes.h"

namespace boxwood::simd {
namespace {

struct Question {
  Vec3 point;
  float max_distance;
};

/// What brute force says; equal distance goes to the smaller key.
TrianglePoint brute_answer(std::span<const Triangle> triangles, std::span<const std::uint32_t> keys,
                           const Question& question) {
  TrianglePoint best;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const ShapePoint found = nearest_point_of(triangles[i], PrimId(i), question.point);
    const std::uint32_t key = keys.empty() ? i : keys[i];
    if (!(found.distance <= question.max_distance)) continue;
    if (found.distance < best.distance || (found.distance == best.distance && key < best.key))
      best = {found.distance, found.position, key, 0};
  }
  return best;
}

bool equals(const TrianglePoint& found, const TrianglePoint& expected, const TriangleTree& tree) {
  if (expected.key == TrianglePoint::kNone)
    return !found.is_found() && found.distance == kInfinity && found.key == TrianglePoint::kNone;
  if (!found.is_found() || found.key != expected.key || !test::same_bits(found.distance, expected.distance))
    return false;
  for (int k = 0; k < 3; ++k)
    if (!test::same_bits(found.position[k], expected.position[k])) return false;
  bool stands_there = false;
  for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane)
    stands_there |= tree.key(found.block, lane) == found.key;
  return stands_there;
}

/// Points of every kind around `triangles`, each without a limit and with the hardest limits.
std::vector<Question> questions_for(std::span<const Triangle> triangles, int count, Random& random) {
  Box3 bounds;
  for (const Triangle& t : triangles) bounds.extend(t.box());
  const float size = max_component(bounds.extent());
  std::vector<Question> questions;
  for (int i = 0; i < count; ++i) {
    const Triangle& t = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
    const float u = random.uniform(), v = random.uniform() * (1 - u);
    const Vec3 inside = t.a + (t.b - t.a) * u + (t.c - t.a) * v, normal = t.normal();
    const Vec3 points[] = {random.in_box(bounds.lower, bounds.upper),
                           t.b,
                           t.a * 0.5f + t.c * 0.5f,
                           inside,
                           inside + normal * (random.uniform(-1, 1) * 0.1f * size),
                           t.c + random.direction() * (1e-6f * size),
                           bounds.center() + random.direction() * min(100 * size, 0x1p35f)};
    for (const Vec3 point : points) {
      questions.push_back({point, kInfinity});
      const float least = brute_answer(triangles, {}, questions.back()).distance;
      const float limits[] = {
          least, std::nextafter(least, 0.0f),      std::nextafter(least, kInfinity), 2 * least,
          0,     std::numeric_limits<float>::max()};
      questions.push_back({point, limits[random.below(6)]});
    }
  }
  return questions;
}

/// Asks `kernels` about a tree; each question anew, and with the place of another answer to look at first.
void expect_equal_to(const Kernels& kernels, const TriangleTree& tree, std::span<const Question> questions,
                     std::span<const TrianglePoint> expected, const std::string& name) {
  std::uint32_t block = TrianglePoint::kNone;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const auto& [point, max_distance] = questions[i];
    TrianglePoint alone, with_hint;
    with_hint.block = block;
    ASSERT_TRUE(kernels.closest_point(tree, point, max_distance, alone));
    ASSERT_TRUE(kernels.closest_point(tree, point, max_distance, with_hint));
    for (const TrianglePoint& found : {alone, with_hint})
      ASSERT_TRUE(equals(found, expected[i], tree))
          << kernels.name << ", " << name << ": point " << i << " (" << point.x << ", " << point.y << ", "
          << point.z << ") within " << max_distance << ": key " << found.key << " at " << found.distance
          << ", expected " << expected[i].key << " at " << expected[i].distance;
    if (alone.is_found()) block = alone.block;
  }
}

/// Every kernel on the trees of every builder.
void expect_equal(const std::string& name, const std::vector<Triangle>& triangles, int count,
                  const std::vector<std::uint32_t>& keys = {}) {
  Random random(4, triangles.size());
  const std::vector<Question> questions = questions_for(triangles, count, random);
  std::vector<TrianglePoint> expected;
  for (const Question& question : questions) expected.push_back(brute_answer(triangles, keys, question));
  for (const auto& [tree_name, bvh] : boxwood::test::every_tree(boxes(triangles)))
    for (const Layout layout : test::kLayouts)
      for (const Kernels* kernels : available_kernels()) {
        const auto tree = test::pack(kernels->width, bvh, triangles, keys, layout);
        expect_equal_to(*kernels, *tree, questions, expected,
                        name + ", " + tree_name + (layout == Layout::compact ? ", compact" : ""));
        if (testing::Test::HasFatalFailure()) return;
      }
}

TEST(KernelClosestPoint, OnMeshesOfEverySizeAndPlace) {
  for (const auto& [name, scale, offset] :
       {std::tuple{"torus", 1.0f, Vec3{0, 0, 0}}, std::tuple{"far away", 1.0f, Vec3{1e3f, -1e4f, 1e4f}},
        std::tuple{"small", 1e-6f, Vec3{0, 0, 0}}, std::tuple{"large", 1e8f, Vec3{0, 0, 0}}})
    expect_equal(name,
                 boxwood::test::triangles(boxwood::test::placed(boxwood::test::torus(12, 7), scale, offset)),
                 12);
}

TEST(KernelClosestPoint, OnSoupAndAFewTriangles) {
  expect_equal("soup", boxwood::test::triangles(boxwood::test::triangle_soup(400)), 30);
  for (const int count : {1, 2, 3, 5, 9, 17})
    expect_equal(std::to_string(count), boxwood::test::random_shapes<Triangle>(count, 17), 8);
}

// Corners on integer coordinates: many triangles are as near as each other.
TEST(KernelClosestPoint, TiesGoToTheSmallestKeyAndDegenerateTrianglesCount) {
  expect_equal("lattice", boxwood::test::lattice_shapes<Triangle>(200, 2), 30);
  expect_equal("degenerate", boxwood::test::degenerate_shapes<Triangle>(200, 3), 30);
  expect_equal("copies", boxwood::test::coincident_shapes<Triangle>(100, 5), 5);

  std::vector<Triangle> triangles = boxwood::test::lattice_shapes<Triangle>(60, 6);
  triangles.insert(triangles.end(), triangles.begin(), triangles.end());
  std::vector<std::uint32_t> keys(triangles.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i) keys[i] = (i * 77 + 13) % 120 * 9'500'000u;
  expect_equal("keys", triangles, 30, keys);
}

// Where squares of floats vanish, and next to where they overflow.
TEST(KernelClosestPoint, AtTheEndsOfWhatFloatsCanSay) {
  for (const float scale : {1e-20f, 1e-30f, 1e-38f, 1e-42f, 0x1p35f})
    expect_equal(
        "scale " + std::to_string(std::log2(scale)),
        boxwood::test::triangles(boxwood::test::placed(boxwood::test::icosphere(1), scale, {0, 0, 0})), 12);
}

// Needles, whose normals are mostly rounding.
TEST(KernelClosestPoint, OnSlivers) {
  Random random(11);
  std::vector<Triangle> slivers;
  for (int i = 0; i < 60; ++i) {
    const Vec3 a = random.in_box(splat(-1), splat(1)), along = random.direction();
    slivers.push_back(
        {a, a + along * random.uniform(1, 100),
         a + along * random.uniform(0, 50) + random.direction() * std::ldexp(1.0f, -int(random.below(24)))});
  }
  expect_equal("slivers", slivers, 30);
}

// A leaf that holds a part of a triangle is as far as that part; the triangle may be nearer by rounding.
TEST(KernelClosestPoint, OnPartsOfTriangles) {
  Random random(12);
  std::vector<Triangle> triangles;
  for (int i = 0; i < 40; ++i) {
    const auto point = [&] { return Vec3{1000, -3000, 20} + random.in_box(splat(-1), splat(1)) * 10.0f; };
    triangles.push_back({point(), point(), point()});
  }
  std::vector<Box3> pieces;
  std::vector<PrimId> owners;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Box3 whole = triangles[i].box();
    for (int cell = 0; cell < 64; ++cell) {
      Box3 region;
      for (int k = 0; k < 3; ++k) {
        const int place = cell >> 2 * k & 3;
        region.lower[k] = whole.lower[k] + whole.extent()[k] * float(place) / 4;
        region.upper[k] =
            place == 3 ? whole.upper[k] : whole.lower[k] + whole.extent()[k] * float(place + 1) / 4;
      }
      const Box3 piece = triangles[i].clipped_box(region);
      if (piece.is_empty()) continue;
      pieces.push_back(piece);
      owners.push_back(PrimId(i));
    }
  }
  const std::vector<Question> questions = questions_for(triangles, 300, random);
  std::vector<TrianglePoint> expected;
  for (const Question& question : questions) expected.push_back(brute_answer(triangles, {}, question));
  Bvh bvh = build(pieces, {.leaf_size = 1});
  for (PrimId& id : bvh.prim_ids) id = owners[id.value];
  const auto check = [&](const Kernels& kernels, auto wide, Layout layout) {
    wide.has_parts = true;
    const TriangleTree tree(wide, std::span<const Triangle>(triangles), {}, serial_executor(), layout);
    ASSERT_TRUE(tree.has_parts());
    expect_equal_to(kernels, tree, questions, expected, "parts");
  };
  const WideCost small_leaves{.node = 0.001f, .block = 100};
  for (const Kernels* kernels : available_kernels())
    for (const Layout layout : test::kLayouts) {
      with_width(kernels->width, [&](auto w) {
        check(*kernels, collapse<w()>(bvh, serial_executor(), small_leaves), layout);
      });
      if (HasFatalFailure()) return;
    }
}

TEST(KernelClosestPoint, UnusualPointsAreHandedBack) {
  const std::vector<Triangle> triangles = boxwood::test::triangles(boxwood::test::icosphere(1));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Kernels* kernels : available_kernels()) {
    const auto tree = test::pack(kernels->width, build(boxes(triangles)), triangles);
    for (const float bad : {nan, kInfinity, -kInfinity, 1e30f, -0x1.000002p36f})
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 point{0, 0, 0};
        point[axis] = bad;
        TrianglePoint untouched{-7, {1, 2, 3}, 77, 777};
        EXPECT_FALSE(kernels->closest_point(*tree, point, kInfinity, untouched));
        EXPECT_EQ(untouched.distance, -7);
        EXPECT_EQ(untouched.block, 777u);
      }
    TrianglePoint found;
    EXPECT_TRUE(kernels->closest_point(*tree, {0x1p36f, 0, -0x1p36f}, kInfinity, found));
    EXPECT_TRUE(found.is_found());
  }
}

}  // namespace
}  // namespace boxwood::simd
