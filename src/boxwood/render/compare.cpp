#include "boxwood/render/compare.h"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "boxwood/core/vec.h"
#include "boxwood/scene/srgb.h"

namespace boxwood::render {
namespace {

std::string shape_of(const Image& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height) + " with " +
         std::to_string(image.channels) + (image.channels == 1 ? " channel" : " channels");
}

/// Luma, as televisions and Wang et al. weigh codes.
std::vector<double> luma(const Image& codes) {
  std::vector<double> grey(std::size_t(codes.width) * std::size_t(codes.height));
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const float* c = &codes.pixels[i * static_cast<std::size_t>(codes.channels)];
    grey[i] = codes.channels >= 3 ? 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2] : c[0];
  }
  return grey;
}

/// The Gaussian mean of value(i) around each place where the window fits: first along rows, then down
/// columns.
template <class Value>
std::vector<double> window_means(int width, int height, const Value& value) {
  constexpr int kSide = 11, kRadius = kSide / 2;
  std::array<double, kSide> weights{};
  double sum = 0;
  for (int i = 0; i < kSide; ++i)
    sum += weights[static_cast<std::size_t>(i)] = std::exp(-(i - kRadius) * (i - kRadius) / 4.5);
  for (double& weight : weights) weight /= sum;

  const int columns = width - kSide + 1, rows = height - kSide + 1;
  std::vector<double> along(std::size_t(columns) * std::size_t(height)),
      means(std::size_t(columns) * std::size_t(rows));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < columns; ++x)
      for (int i = 0; i < kSide; ++i)
        along[std::size_t(y) * std::size_t(columns) + std::size_t(x)] +=
            weights[static_cast<std::size_t>(i)] *
            value(std::size_t(y) * std::size_t(width) + std::size_t(x + i));
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      for (int i = 0; i < kSide; ++i)
        means[std::size_t(y) * std::size_t(columns) + std::size_t(x)] +=
            weights[static_cast<std::size_t>(i)] *
            along[std::size_t(y + i) * std::size_t(columns) + std::size_t(x)];
  return means;
}

}  // namespace

void check_same_shape(const Image& picture, const Image& reference) {
  if (picture.width != reference.width || picture.height != reference.height ||
      picture.channels != reference.channels)
    throw std::invalid_argument("the pictures differ in shape: " + shape_of(picture) + ", and " +
                                shape_of(reference));
}

double relative_mse(const Image& picture, const Image& reference) {
  check_same_shape(picture, reference);
  double sum = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const double b = reference.pixels[i], difference = picture.pixels[i] - b;
    sum += difference * difference / (b * b + 0.01);
  }
  return sum / static_cast<double>(picture.pixels.size());
}

Image screen_codes(const Image& light) {
  Image codes = light;
  for (float& x : codes.pixels) x = srgb_from_linear(min(1.0f, max(0.0f, x)));
  return codes;
}

double psnr_db(const Image& picture_codes, const Image& reference_codes) {
  check_same_shape(picture_codes, reference_codes);
  double sum = 0;
  for (std::size_t i = 0; i < picture_codes.pixels.size(); ++i) {
    const double difference = double(picture_codes.pixels[i]) - reference_codes.pixels[i];
    sum += difference * difference;
  }
  if (sum == 0) return std::numeric_limits<double>::infinity();
  return -10 * std::log10(sum / static_cast<double>(picture_codes.pixels.size()));
}

std::optional<double> ssim(const Image& picture_codes, const Image& reference_codes) {
  check_same_shape(picture_codes, reference_codes);
  const int width = picture_codes.width, height = picture_codes.height;
  if (width < 11 || height < 11) return std::nullopt;
  const std::vector<double> a = luma(picture_codes), b = luma(reference_codes);
  const auto means = [&](const auto& value) { return window_means(width, height, value); };
  const std::vector<double> mean_a = means([&](std::size_t i) { return a[i]; }),
                            mean_b = means([&](std::size_t i) { return b[i]; }),
                            mean_aa = means([&](std::size_t i) { return a[i] * a[i]; }),
                            mean_bb = means([&](std::size_t i) { return b[i] * b[i]; }),
                            mean_ab = means([&](std::size_t i) { return a[i] * b[i]; });

  // Equation 13 with K1 = 0.01, K2 = 0.03 and a range of 1.
  constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
  double sum = 0;
  for (std::size_t i = 0; i < mean_a.size(); ++i) {
    const double aa = mean_a[i] * mean_a[i], bb = mean_b[i] * mean_b[i], ab = mean_a[i] * mean_b[i];
    sum += (2 * ab + kC1) * (2 * (mean_ab[i] - ab) + kC2) /
           ((aa + bb + kC1) * (mean_aa[i] - aa + mean_bb[i] - bb + kC2));
  }
  return sum / static_cast<double>(mean_a.size());
}

}  // namespace boxwood::render
