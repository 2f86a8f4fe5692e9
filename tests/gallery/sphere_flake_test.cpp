// sphere_flake_test.cpp: does the flake have all its balls, each touching its parent?

#include "boxwood/gallery/sphere_flake.h"

#include <gtest/gtest.h>

namespace boxwood::gallery {
namespace {

TEST(SphereFlake, CountsAndStaysWithinTwiceItsRadius) {
  for (const auto& [levels, count] : {std::pair{1, 1u}, {2, 10u}, {3, 91u}, {4, 820u}, {5, 7381u}}) {
    const std::vector<Sphere> flake = sphere_flake({1, 2, 3}, 0.5f, {0, 1, 0}, levels);
    EXPECT_EQ(flake.size(), count);
    for (const Sphere& sphere : flake)
      EXPECT_LE(length(sphere.center - Vec3{1, 2, 3}) + sphere.radius, 1.0001f);
  }
}

TEST(SphereFlake, ChildrenTouchTheRootAndSitAboveItsEquator) {
  const std::vector<Sphere> flake = sphere_flake({0, 0, 0}, 3, {0, 1, 0}, 2);
  for (std::size_t i = 1; i < flake.size(); ++i) {
    EXPECT_NEAR(length(flake[i].center), 4, 1e-5);
    EXPECT_EQ(flake[i].radius, 1);
    EXPECT_GE(flake[i].center.y, -1e-5);
    for (std::size_t k = i + 1; k < flake.size(); ++k)
      EXPECT_GT(length(flake[i].center - flake[k].center), 2) << i << ' ' << k;
  }
}

}  // namespace
}  // namespace boxwood::gallery
