#include "boxwood/render/flip.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "boxwood/core/vec.h"
#include "boxwood/render/compare.h"

namespace boxwood::render {
namespace {

constexpr double kPi = std::numbers::pi;

/// A color of three doubles.
struct Triple {
  double x = 0, y = 0, z = 0;
};

/// Planes of doubles, one value a pixel.
struct Plane {
  int width, height;
  std::vector<double> values;
  Plane(int w, int h) : width(w), height(h), values(std::size_t(w) * std::size_t(h)) {}
  double& at(int x, int y) { return values[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
  double at(int x, int y) const { return const_cast<Plane*>(this)->at(x, y); }
};

// ---- Colors: linear sRGB, XYZ, the opponent space YCxCz (linear) and CIELAB (as seen).

// Rows of the matrix from linear sRGB to XYZ, by the chromaticities of Rec. 709 and the white D65.
constexpr double kXyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                               {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                               {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
// Its inverse, by cofactors.
struct Inverse {
  double m[3][3];
};
constexpr Inverse kFromXyz = [] {
  Inverse inverse{};
  double determinant = 0;
  const auto cofactor = [](int r, int c) {
    const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return kXyz[r1][c1] * kXyz[r2][c2] - kXyz[r1][c2] * kXyz[r2][c1];
  };
  for (int c = 0; c < 3; ++c) determinant += kXyz[0][c] * cofactor(0, c);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) inverse.m[c][r] = cofactor(r, c) / determinant;
  return inverse;
}();

Triple times(const double (&m)[3][3], Triple v) {
  return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
          m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

/// XYZ divided by that of white.
Triple relative_xyz(Triple rgb) {
  const Triple xyz = times(kXyz, rgb), white = times(kXyz, {1, 1, 1});
  return {xyz.x / white.x, xyz.y / white.y, xyz.z / white.z};
}

Triple opponent_from_rgb(Triple rgb) {
  const Triple r = relative_xyz(rgb);
  return {116 * r.y - 16, 500 * (r.x - r.y), 200 * (r.y - r.z)};
}

Triple rgb_from_opponent(Triple opponent) {
  const double y = (opponent.x + 16) / 116;
  const Triple white = times(kXyz, {1, 1, 1});
  return times(kFromXyz.m, {(opponent.y / 500 + y) * white.x, y * white.y, (y - opponent.z / 200) * white.z});
}

/// CIELAB with Hunt's effect: colors look the fuller the lighter they are (section 4.2 of the paper).
Triple seen_color(Triple rgb) {
  const auto curve = [](double t) {
    constexpr double kStep = 6.0 / 29;
    return t > kStep * kStep * kStep ? std::cbrt(t) : t / (3 * kStep * kStep) + 4.0 / 29;
  };
  const Triple r = relative_xyz(rgb);
  const double lightness = 116 * curve(r.y) - 16;
  const double a = 500 * (curve(r.x) - curve(r.y)), b = 200 * (curve(r.y) - curve(r.z));
  return {lightness, 0.01 * lightness * a, 0.01 * lightness * b};
}

/// The distance HyAB of Abasi, Amani Tehran and Fairchild, 2020: for large differences of color.
double color_distance(Triple a, Triple b) {
  return std::fabs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// ---- Filters. Beyond the edge a picture goes on as it ends.

using Kernel = std::vector<double>;  // of odd length

/// The plane filtered along rows by one kernel and down columns by another.
Plane filtered(const Plane& plane, const Kernel& across, const Kernel& down) {
  const auto pass = [](const Plane& from, const Kernel& kernel, int step_x, int step_y) {
    const int radius = static_cast<int>(kernel.size() / 2);
    Plane to(from.width, from.height);
    for (int y = 0; y < from.height; ++y)
      for (int x = 0; x < from.width; ++x)
        for (int i = -radius; i <= radius; ++i)
          to.at(x, y) += kernel[static_cast<std::size_t>(i + radius)] *
                         from.at(std::clamp(x + i * step_x, 0, from.width - 1),
                                 std::clamp(y + i * step_y, 0, from.height - 1));
    return to;
  };
  return pass(pass(plane, across, 1, 0), down, 0, 1);
}

template <class Function>
Kernel kernel_of(int radius, const Function& function) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(function(i));
  return kernel;
}

double sum_of(const Kernel& kernel) {
  double sum = 0;
  for (const double weight : kernel) sum += weight;
  return sum;
}

/// Positive weights sum up to 1, negative ones to -1.
Kernel balanced(Kernel kernel) {
  double positive = 0, negative = 0;
  for (const double weight : kernel) (weight > 0 ? positive : negative) += weight;
  for (double& weight : kernel) weight /= weight > 0 ? positive : -negative;
  return kernel;
}

/// A Gaussian a sqrt(pi / b) exp(-pi^2 x^2 / b) of the distance in degrees.
struct Bell {
  double a, b;
};

/// What the eye lets through of a channel (table 1 of the paper): a sum of two Gaussians in two dimensions.
Plane seen_details(const Plane& plane, const Bell (&bells)[2], double pixels_per_degree) {
  constexpr double kWidestBell = 0.04;
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(kWidestBell / (2 * kPi * kPi)) * pixels_per_degree));
  Plane sum(plane.width, plane.height);
  double weights = 0;
  for (const Bell& bell : bells) {
    if (bell.a == 0) continue;
    const Kernel kernel = kernel_of(radius, [&](int i) {
      const double x = i / pixels_per_degree;
      return std::exp(-kPi * kPi * x * x / bell.b);
    });
    const double height = bell.a * std::sqrt(kPi / bell.b);
    const Plane part = filtered(plane, kernel, kernel);
    for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += height * part.values[i];
    weights += height * sum_of(kernel) * sum_of(kernel);
  }
  for (double& value : sum.values) value /= weights;
  return sum;
}

/// How much of an edge, and of a point, there is at each pixel of a plane of lightness.
struct FeaturePlanes {
  Plane edges, points;
};

FeaturePlanes features_of(const Plane& lightness, double pixels_per_degree) {
  constexpr double kFeatureWidth = 0.082;  // degrees, of the features that eyes are best at
  const double deviation = 0.5 * kFeatureWidth * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const auto bell = [&](int i) { return std::exp(-i * i / (2 * deviation * deviation)); };
  Kernel smooth = kernel_of(radius, bell);
  const double sum = sum_of(smooth);
  for (double& weight : smooth) weight /= sum;
  const Kernel slope = balanced(kernel_of(radius, [&](int i) { return -i * bell(i); }));
  const Kernel bend =
      balanced(kernel_of(radius, [&](int i) { return (i * i / (deviation * deviation) - 1) * bell(i); }));

  const auto strength = [&](const Kernel& kernel) {
    Plane x = filtered(lightness, kernel, smooth);
    const Plane y = filtered(lightness, smooth, kernel);
    for (std::size_t i = 0; i < x.values.size(); ++i) x.values[i] = std::hypot(x.values[i], y.values[i]);
    return x;
  };
  return {strength(slope), strength(bend)};
}

/// A picture as the eye takes it in: filtered colors, and the features of what is not filtered.
struct Seen {
  std::vector<Triple> colors;
  FeaturePlanes features;
};

Seen seen(const Image& picture, double pixels_per_degree) {
  const int width = picture.width, height = picture.height;
  Plane planes[3] = {{width, height}, {width, height}, {width, height}};
  Plane lightness(width, height);
  for (std::size_t i = 0; i < lightness.values.size(); ++i) {
    const auto channel = [&](std::size_t c) {
      return double(min(1.0f, max(0.0f, picture.pixels[3 * i + c])));
    };
    const Triple opponent = opponent_from_rgb({channel(0), channel(1), channel(2)});
    planes[0].values[i] = opponent.x;
    planes[1].values[i] = opponent.y;
    planes[2].values[i] = opponent.z;
    lightness.values[i] = (opponent.x + 16) / 116;
  }

  constexpr Bell kLightness[2] = {{1, 0.0047}, {0, 1}}, kRedGreen[2] = {{1, 0.0053}, {0, 1}},
                 kBlueYellow[2] = {{34.1, 0.04}, {13.5, 0.025}};
  const Plane details[3] = {seen_details(planes[0], kLightness, pixels_per_degree),
                            seen_details(planes[1], kRedGreen, pixels_per_degree),
                            seen_details(planes[2], kBlueYellow, pixels_per_degree)};
  Seen result{{}, features_of(lightness, pixels_per_degree)};
  result.colors.reserve(lightness.values.size());
  for (std::size_t i = 0; i < lightness.values.size(); ++i) {
    const Triple rgb = rgb_from_opponent({details[0].values[i], details[1].values[i], details[2].values[i]});
    result.colors.push_back(
        seen_color({std::clamp(rgb.x, 0.0, 1.0), std::clamp(rgb.y, 0.0, 1.0), std::clamp(rgb.z, 0.0, 1.0)}));
  }
  return result;
}

/// From a distance of colors to an error in [0, 1] (section 4.3): small ones get most of the range.
double color_error(double distance) {
  constexpr double kExponent = 0.7, kKnee = 0.4, kKneeError = 0.95;
  static const double largest =
      std::pow(color_distance(seen_color({0, 1, 0}), seen_color({0, 0, 1})), kExponent);
  const double power = std::pow(distance, kExponent), knee = kKnee * largest;
  return power < knee ? kKneeError / knee * power
                      : kKneeError + (power - knee) / (largest - knee) * (1 - kKneeError);
}

}  // namespace

Image flip_map(const Image& picture, const Image& reference, double pixels_per_degree) {
  check_same_shape(picture, reference);
  if (picture.channels != 3)
    throw std::invalid_argument("FLIP compares pictures of 3 channels, not of " +
                                std::to_string(picture.channels));
  const Seen a = seen(picture, pixels_per_degree), b = seen(reference, pixels_per_degree);
  Image map(picture.width, picture.height, 1);
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    const double color = color_error(color_distance(a.colors[i], b.colors[i]));
    const double edge = std::fabs(a.features.edges.values[i] - b.features.edges.values[i]);
    const double point = std::fabs(a.features.points.values[i] - b.features.points.values[i]);
    // Equations 5 and 6: where features differ, the color's error is raised.
    const double feature = std::sqrt(std::max(edge, point) / std::numbers::sqrt2);
    map.pixels[i] = static_cast<float>(std::pow(color, 1 - feature));
  }
  return map;
}

double mean_of(const Image& map) {
  double sum = 0;
  for (const float x : map.pixels) sum += x;
  return map.pixels.empty() ? 0 : sum / static_cast<double>(map.pixels.size());
}

}  // namespace boxwood::render
