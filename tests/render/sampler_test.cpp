// The sampler: well spread, unrelated between pixels, and a function of its arguments.
#include "boxwood/render/sampler.h"

#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace boxwood::render {
namespace {

TEST(Sampler, FirstPowersOfTwoHitEveryElementaryBoxOnce) {
  for (const std::uint32_t pixel : {0u, 1u, 77777u}) {
    for (int skipped = 0; skipped < 5; ++skipped) {
      for (const std::uint32_t log_count : {1u, 4u, 6u, 9u}) {
        const std::uint32_t count = 1u << log_count;
        std::vector<Vec2> points;
        for (std::uint32_t s = 0; s < count; ++s) {
          Sampler sampler(pixel, s);
          for (int d = 0; d < skipped; ++d) sampler.next_2d();
          points.push_back(sampler.next_2d());
        }
        for (std::uint32_t log_x = 0; log_x <= log_count; ++log_x) {
          const auto columns = static_cast<float>(1u << log_x),
                     rows = static_cast<float>(1u << (log_count - log_x));
          std::set<std::pair<int, int>> boxes;
          for (const Vec2 p : points) {
            ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
            boxes.insert({static_cast<int>(p.x * columns), static_cast<int>(p.y * rows)});
          }
          EXPECT_EQ(boxes.size(), count)
              << "pixel " << pixel << ", pair " << skipped << ", " << columns << " columns";
        }
      }
    }
  }
}

TEST(Sampler, IsAFunctionOfItsArguments) {
  Sampler a(5, 6), b(5, 6);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(a.next_2d(), b.next_2d());
}

TEST(Sampler, PixelsAndDimensionsAreUnrelated) {
  // The correlation of the same sample in neighbouring pixels, and of neighbouring dimensions.
  double pixels = 0, dimensions = 0;
  constexpr int kCount = 20000;
  for (std::uint32_t pixel = 0; pixel < kCount; ++pixel) {
    Sampler here(pixel, 3), there(pixel + 1, 3);
    const float x = here.next_1d(), y = here.next_1d(), z = there.next_1d();
    pixels += (x - 0.5) * (z - 0.5);
    dimensions += (x - 0.5) * (y - 0.5);
  }
  // The variance of a product is 1/144; four standard deviations of the mean.
  const double bound = 4.0 / 12 / std::sqrt(double(kCount));
  EXPECT_LT(std::abs(pixels / kCount), bound);
  EXPECT_LT(std::abs(dimensions / kCount), bound);
}

}  // namespace
}  // namespace boxwood::render
