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

FilterSampler::FilterSampler(Filter filter) : filter_(filter), radius_(filter_radius(filter)) {
  // Integrate the magnitude over each cell by Simpson's rule.
  const double width = 2.0 * radius_ / kCells;
  std::array<double, kCells + 1> below{};
  const auto magnitude = [&](double x) { return std::fabs(filter_value(filter_, x)); };
  for (int i = 0; i < kCells; ++i) {
    const double a = i * width - radius_;
    below[i + 1] = below[i] + magnitude(a) + 4 * magnitude(a + width / 2) + magnitude(a + width);
  }
  for (int i = 0; i <= kCells; ++i) share_[i] = static_cast<float>(below[i] / below[kCells]);

  // The share of the lobe at the lower end, if there is one: up to where the filter changes sign.
  double negative = 0;
  for (int i = 0; i < kCells / 2; ++i)
    if (filter_value(filter_, (i + 0.5) * width - radius_) < 0) negative = below[i + 1] / below[kCells];
  negative_ = static_cast<float>(negative);
}

float FilterSampler::along_axis(float u) const {
  // The cell whose share of the integral holds u; inside it the filter is taken for even.
  const auto after = std::upper_bound(share_.begin() + 1, share_.end() - 1, u);
  const auto cell = static_cast<std::size_t>(after - share_.begin()) - 1;
  const float inside = (u - share_[cell]) / (share_[cell + 1] - share_[cell]);
  return (static_cast<float>(cell) + inside) * (2 * radius_ / kCells) - radius_;
}

/// The same in the positive part alone, or in both negative lobes.
float FilterSampler::along_axis(float u, bool is_negative) const {
  if (!is_negative) return along_axis(negative_ + u * (1 - 2 * negative_));
  return along_axis(u < 0.5f ? 2 * u * negative_ : 1 - 2 * (1 - u) * negative_);
}

FilterSample FilterSampler::sample(Vec2 u, std::uint32_t index) const {
  if (filter_ == Filter::box) return {{u.x - 0.5f, u.y - 0.5f}};
  if (filter_ == Filter::tent) return {{tent(u.x), tent(u.y)}};
  if (!(negative_ > 0)) return {{along_axis(u.x), along_axis(u.y)}};

  // The product of both axes is negative where one of them is. Whether it is this sample's turn: whether the
  // negative share of all samples so far passes a whole number.
  const double along = 2.0 * negative_, share = 2 * along * (1 - along);
  const bool is_negative = std::floor((index + 1.0) * share) > std::floor(index * share);
  // One of the two parts that the plane has of this sign; what is left of u.x goes on.
  const double first = is_negative ? 0.5 : along * along / (1 - share);
  const bool is_first = u.x < first;
  const double left = is_first ? u.x / first : (u.x - first) / (1 - first);
  const float x = std::min(static_cast<float>(left), 0x1.fffffep-1f);
  return {{along_axis(x, is_first), along_axis(u.y, is_first != is_negative)}, is_negative ? -1 : 1};
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
