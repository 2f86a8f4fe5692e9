// Trees over pieces of primitives: nothing is lost, and long triangles gain.
#include "boxwood/build/spatial_split.h"

#include <gtest/gtest.h>

#include "boxwood/build/build.h"
#include "boxwood/core/random.h"
#include "boxwood/tree/metrics.h"
#include "boxwood/tree/validate.h"
#include "support/box_sets.h"

namespace boxwood {
namespace {

using test::box_sets;
using test::BoxSet;

/// Segments from corner to corner of their boxes, which are as badly boxed as anything.
std::vector<Box3> long_boxes(int count) {
  Random random(3);
  std::vector<Box3> boxes;
  for (int i = 0; i < count; ++i) {
    const Vec3 corner = random.in_box({0, 0, 0}, {1, 1, 1});
    boxes.push_back({corner, corner + random.in_box(splat(0.05f), splat(0.3f))});
  }
  return boxes;
}

/// The box of the part of the diagonal of `box` inside `region`, a little larger than it is.
Box3 clip_diagonal(const Box3& box, const Box3& region) {
  double from = 0, to = 1;
  for (int k = 0; k < 3; ++k) {
    const double extent = double(box.upper[k]) - box.lower[k];
    if (extent == 0) continue;
    from = std::max(from, (double(region.lower[k]) - box.lower[k]) / extent - 1e-6);
    to = std::min(to, (double(region.upper[k]) - box.lower[k]) / extent + 1e-6);
  }
  if (from > to) return {};
  Box3 part;
  for (int k = 0; k < 3; ++k) {
    const double extent = double(box.upper[k]) - box.lower[k];
    part.lower[k] = std::nextafter(float(box.lower[k] + from * extent), -kInfinity);
    part.upper[k] = std::nextafter(float(box.lower[k] + to * extent), kInfinity);
  }
  part = intersect(part, intersect(box, region));
  return part.is_empty() ? Box3{} : part;
}

TEST(SpatialSplit, CutsAtMostWhatItMayAndLosesNothing) {
  std::vector<BoxSet> sets = box_sets();
  sets.push_back({"long", long_boxes(3000)});
  for (const BoxSet& set : sets)
    for (const float share : {0.1f, 1.0f, 4.0f}) {
      const Clip clip = [&](PrimId id, const Box3& region) {
        return clip_diagonal(set.boxes[id.value], region);
      };
      const Pieces pieces = split_spatially(set.boxes, clip, share, serial_executor());
      ASSERT_EQ(pieces.boxes.size(), pieces.owners.size());
      EXPECT_LE(double(pieces.boxes.size()), (1 + share) * double(set.boxes.size())) << set.name;
      std::vector<Box3> covered(set.boxes.size());
      for (std::size_t i = 0; i < pieces.boxes.size(); ++i) {
        const Box3& whole = set.boxes[pieces.owners[i].value];
        ASSERT_TRUE(whole.contains(pieces.boxes[i])) << set.name;
        covered[pieces.owners[i].value].extend(pieces.boxes[i]);
      }
      for (std::size_t i = 0; i < set.boxes.size(); ++i)
        ASSERT_EQ(covered[i].is_empty() ? Box3{} : covered[i],
                  set.boxes[i].is_empty() ? Box3{} : set.boxes[i])
            << set.name;
    }
}

TEST(SpatialSplit, TreesAreLegalAndTheSameForAnyNumberOfThreads) {
  std::vector<BoxSet> sets = box_sets();
  sets.push_back({"long", long_boxes(20'000)});
  const auto eight = make_executor(8);
  for (const BoxSet& set : sets) {
    const Clip clip = [&](PrimId id, const Box3& region) {
      return clip_diagonal(set.boxes[id.value], region);
    };
    BuildOptions o = BuildOptions::best();
    o.executor = &serial_executor();
    const Bvh bvh = build(set.boxes, clip, o);
    ASSERT_EQ(validate(bvh, set.boxes, Repeats::allowed), "") << set.name;
    o.executor = eight.get();
    EXPECT_TRUE(build(set.boxes, clip, o) == bvh) << set.name;
  }
}

TEST(SpatialSplit, PaysForLongPrimitives) {
  // A few long ones among many small ones.
  std::vector<Box3> boxes = test::soup_boxes(20'000, 5, 0.02f);
  for (const Box3& box : long_boxes(500)) boxes.push_back(box);
  const Clip clip = [&](PrimId id, const Box3& region) { return clip_diagonal(boxes[id.value], region); };
  BuildOptions o = BuildOptions::best();
  const Bvh split = build(boxes, clip, o);
  EXPECT_GT(split.prim_ids.size(), boxes.size());
  EXPECT_LT(sah_cost(split), 0.9 * sah_cost(build(boxes, o)));
}

TEST(SpatialSplit, FlatPrimitivesStayWhole) {
  // Walls: flat boxes have nothing to spare.
  std::vector<Box3> boxes = test::soup_boxes(1000, 1, 0.01f);
  boxes.push_back({{0, 0, 0}, {1, 1, 0}});
  boxes.push_back({{0, 0, 0}, {0, 1, 1}});
  const Clip clip = [&](PrimId id, const Box3& region) { return intersect(boxes[id.value], region); };
  const Pieces pieces = split_spatially(boxes, clip, 1, serial_executor());
  for (const std::uint32_t wall : {1000u, 1001u})
    EXPECT_EQ(std::count(pieces.owners.begin(), pieces.owners.end(), PrimId(wall)), 1);
}

TEST(SpatialSplit, ErrorsAndProgressComeThrough) {
  const std::vector<Box3> boxes = long_boxes(5000);
  const Clip clip = [&](PrimId id, const Box3& region) { return clip_diagonal(boxes[id.value], region); };
  const Clip broken = [](PrimId, const Box3&) -> Box3 { throw std::runtime_error("no such shape"); };
  BuildOptions o = BuildOptions::best();
  EXPECT_THROW(build(boxes, broken, o), std::runtime_error);
  double last = 0;
  o.progress = [&](std::string_view, double done) {
    EXPECT_GE(done, last);
    last = done;
    return true;
  };
  build(boxes, clip, o);
  EXPECT_EQ(last, 1);
  o.split_share = -1;
  EXPECT_THROW(build(boxes, clip, o), std::invalid_argument);
  std::vector<Box3> bad = boxes;
  bad[7].lower.x = std::nanf("");
  o = BuildOptions::best();
  EXPECT_THROW(build(bad, clip, o), std::invalid_argument);
}

}  // namespace
}  // namespace boxwood
