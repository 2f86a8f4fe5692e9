// Pixel filters: samples fall where the filter has its weight, with its sign.
#include "boxwood/render/filter.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "boxwood/render/sampler.h"

namespace boxwood::render {
namespace {

constexpr Filter kAll[] = {Filter::box, Filter::tent, Filter::gaussian, Filter::mitchell,
                           Filter::blackman_harris};

/// The integral over [a, b], by the midpoint rule.
template <class Function>
double integral(double a, double b, const Function& f) {
  constexpr int kSteps = 2000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += f(a + (i + 0.5) * (b - a) / kSteps);
  return sum * (b - a) / kSteps;
}

TEST(Filters, SamplesFallWhereTheWeightIs) {
  for (const Filter filter : kAll) {
    const FilterSampler sampler(filter);
    const double radius = filter_radius(filter);
    const auto value = [&](double x) { return filter_value(filter, x); };
    const double magnitude = integral(-radius, radius, [&](double x) { return std::fabs(value(x)); });
    const double net = integral(-radius, radius, value);

    // A grid of points; along x they are counted in bins, with the signs that y adds on average.
    constexpr int kPoints = 400, kBins = 16;
    std::array<double, kBins> counts{};
    std::uint32_t index = 0;
    for (int i = 0; i < kPoints; ++i)
      for (int j = 0; j < kPoints; ++j) {
        const FilterSample sample = sampler.sample({(i + 0.5f) / kPoints, (j + 0.5f) / kPoints}, index++);
        ASSERT_LE(std::fabs(sample.offset.x), radius);
        ASSERT_LE(std::fabs(sample.offset.y), radius);
        const int bin = static_cast<int>((sample.offset.x + radius) / (2 * radius) * kBins);
        counts[static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1))] += sample.sign;
      }
    for (int bin = 0; bin < kBins; ++bin) {
      const double a = -radius + 2 * radius * bin / kBins, b = a + 2 * radius / kBins;
      const double expected = integral(a, b, value) / magnitude * (net / magnitude);
      EXPECT_NEAR(counts[static_cast<std::size_t>(bin)] / (kPoints * kPoints), expected, 0.004)
          << filter_name(filter) << ", bin " << bin;
    }
  }
}

TEST(Filters, SignsComeEvenlyAndNeverLeaveAPixelWithoutAMean) {
  // The share of the plane's magnitude that is negative, by quadrature.
  const auto value = [](double x) { return filter_value(Filter::mitchell, x); };
  const double magnitude = integral(-2, 2, [&](double x) { return std::fabs(value(x)); });
  const double net = integral(-2, 2, value) / magnitude;
  const double share = (1 - net * net) / 2;

  const FilterSampler sampler(Filter::mitchell);
  int negative = 0;
  for (std::uint32_t index = 0; index < 5000; ++index) {
    Sampler numbers(3, index);
    const FilterSample sample = sampler.sample(numbers.next_2d(), index);
    const double at = value(sample.offset.x) * value(sample.offset.y);
    // Within a cell the filter is taken for even, so a sample may fall a little beyond a zero.
    if (std::fabs(at) > 0.05) {
      EXPECT_EQ(sample.sign, at > 0 ? 1 : -1) << index;
    }
    negative += sample.sign < 0;
    const double count = index + 1.0;
    ASSERT_NEAR(negative, share * count, 1 + 0.001 * count) << count;
    ASSERT_LE(negative, share * count + 0.001 * count) << count;
  }
  for (const Filter filter : {Filter::box, Filter::tent, Filter::gaussian, Filter::blackman_harris})
    for (std::uint32_t index = 0; index < 200; ++index)
      EXPECT_EQ(FilterSampler(filter).sample({0.3f, 0.9f}, index).sign, 1);
}

TEST(Filters, HaveTheShapesOfTheirPapers) {
  // Mitchell and Netravali: 16/18 in the middle, 1/18 at 1, 0 at 2, negative in between; all shifts sum up
  // to 1.
  EXPECT_NEAR(filter_value(Filter::mitchell, 0) / 18, 16.0 / 18, 1e-12);
  EXPECT_NEAR(filter_value(Filter::mitchell, 1) / 18, 1.0 / 18, 1e-12);
  EXPECT_NEAR(filter_value(Filter::mitchell, 2), 0, 1e-12);
  EXPECT_LT(filter_value(Filter::mitchell, 1.5), 0);
  for (const double x : {0.0, 0.2, 0.5, 0.9}) {
    double sum = 0;
    for (int k = -2; k <= 2; ++k) sum += filter_value(Filter::mitchell, x + k) / 18;
    EXPECT_NEAR(sum, 1, 1e-12) << x;
  }
  // The window's four terms add up to 1 in the middle and nearly vanish at the edge.
  EXPECT_NEAR(filter_value(Filter::blackman_harris, 0), 1, 1e-12);
  EXPECT_NEAR(filter_value(Filter::blackman_harris, 1.5), 6e-5, 1e-12);
  EXPECT_NEAR(filter_value(Filter::gaussian, 1.5), 0, 1e-12);
  EXPECT_NEAR(filter_value(Filter::tent, 0.25), 0.75, 1e-12);
}

TEST(Filters, HaveNames) {
  for (const Filter filter : kAll) EXPECT_EQ(filter_from_name(filter_name(filter)), filter);
  EXPECT_THROW(filter_from_name("round"), std::invalid_argument);
}

}  // namespace
}  // namespace boxwood::render
