#include "boxwood/render/filter.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "boxwood/render/warp.h"

namespace boxwood::render {
namespace {

struct NamedFilter {
  Filter filter;
  std::string_view name;
  float radius;
};
constexpr NamedFilter kFilters[] = {{Filter::box, "box", 0.5f},
                                    {Filter::tent, "tent", 1},
                                    {Filter::gaussian, "gaussian", 1.5f},
                                    {Filter::mitchell, "mitchell", 2},
                                    {Filter::blackman_harris, "blackman-harris", 1.5f}};

/// "Reconstruction Filters in Computer Graphics", 1988, equation 8 with B = C = 1/3, times 18.
double mitchell(double x) {
  return x < 1 ? (21 * x - 36) * x * x + 16 : ((-7 * x + 36) * x - 60) * x + 32;
}

/// Harris, "On the Use of Windows for Harmonic Analysis", 1978, table 1: the minimum 4-term window.
double blackman_harris(double x, double radius) {
  const double phase = 3.14159265358979323846 * (x / radius + 1);
  return 0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2 * phase) - 0.01168 * std::cos(3 * phase);
}

}  // namespace

double filter_value(Filter filter, double x) {
  const double radius = filter_radius(filter);
  x = std::fabs(x);
  if (x > radius) return 0;
  switch (filter) {
    case Filter::box:
      return 1;
    case Filter::tent:
      return 1 - x;
    case Filter::gaussian:
      return std::exp(-2 * x * x) - std::exp(-2 * radius * radius);
    case Filter::mitchell:
      return mitchell(x);
    case Filter::blackman_harris:
      return blackman_harris(x, radius);
  }
  return 0;
}

float filter_radius(Filter filter) {
  for (const NamedFilter& named : kFilters)
    if (named.filter == filter) return named.radius;
  return 0;
}

FilterSampler::FilterSampler(Filter filter)
    : filter_(filter), radius_(filter_radius(filter)), zero_(filter_radius(filter)) {
  // Integrate the magnitude over each cell by Simpson's rule.
  const double width = 2.0 * radius_ / kCells;
  std::array<double, kCells + 1> below{};
  const auto magnitude = [&](double x) { return std::fabs(filter_value(filter_, x)); };
  for (int i = 0; i < kCells; ++i) {
    const double a = i * width - radius_;
    below[i + 1] = below[i] + magnitude(a) + 4 * magnitude(a + width / 2) + magnitude(a + width);
  }
  for (int i = 0; i <= kCells; ++i) share_[i] = static_cast<float>(below[i] / below[kCells]);

  // The place where a filter with negative lobes changes sign, by bisection.
  if (filter_value(filter_, 0.75 * radius_) >= 0) return;
  double positive = 0, negative = 0.75 * radius_;
  for (int i = 0; i < 60; ++i) {
    const double middle = (positive + negative) / 2;
    (filter_value(filter_, middle) < 0 ? negative : positive) = middle;
  }
  zero_ = static_cast<float>(positive);
}

FilterSampler::Axis FilterSampler::along_axis(float u) const {
  // The cell whose share of the integral holds u; inside it the filter is taken for even.
  const auto after = std::upper_bound(share_.begin() + 1, share_.end() - 1, u);
  const auto cell = static_cast<std::size_t>(after - share_.begin()) - 1;
  const float inside = (u - share_[cell]) / (share_[cell + 1] - share_[cell]);
  const float x = (static_cast<float>(cell) + inside) * (2 * radius_ / kCells) - radius_;
  return {x, std::fabs(x) > zero_};
}

FilterSample FilterSampler::sample(Vec2 u) const {
  if (filter_ == Filter::box) return {{u.x - 0.5f, u.y - 0.5f}};
  if (filter_ == Filter::tent) return {{tent(u.x), tent(u.y)}};
  const Axis x = along_axis(u.x), y = along_axis(u.y);
  return {{x.offset, y.offset}, x.is_negative != y.is_negative ? -1 : 1};
}

std::string_view filter_name(Filter filter) {
  for (const NamedFilter& named : kFilters)
    if (named.filter == filter) return named.name;
  return "";
}

Filter filter_from_name(std::string_view name) {
  std::string known;
  for (const NamedFilter& named : kFilters) {
    if (named.name == name) return named.filter;
    known += (known.empty() ? "" : ", ") + std::string(named.name);
  }
  throw std::invalid_argument("'" + std::string(name) + "' is not a filter; expected one of " + known);
}

}  // namespace boxwood::render
