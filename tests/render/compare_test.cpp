// Numbers of a comparison beside those of other programs, worked out once for two pictures of whole codes:
// numpy for MSE and PSNR, scikit-image 0.26 for SSIM, NVIDIA's flip-evaluator for FLIP.
#include "boxwood/render/compare.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "boxwood/core/random.h"
#include "boxwood/render/flip.h"
#include "boxwood/scene/srgb.h"

namespace boxwood::render {
namespace {

constexpr int kWidth = 64, kHeight = 48;

int reference_code(int x, int y, int c) {
  return 90 + (x * (c + 1) + y * (3 - c)) % 120;
}

/// The same with a box of another color, and noise.
int picture_code(int x, int y, int c) {
  int code = reference_code(x, y, c);
  if (x >= 20 && x < 34 && y >= 12 && y < 30) code += 40 - 30 * c;
  return std::clamp(code + (x * 37 + y * 101 + c * 59) % 11 - 5, 0, 255);
}

template <class Code>
Image image_of(const Code& code) {
  Image image(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] = linear_from_srgb(static_cast<float>(code(x, y, c)) / 255);
  return image;
}

TEST(Compare, HasTheNumbersOfOtherPrograms) {
  const Image picture = image_of(picture_code), reference = image_of(reference_code);
  EXPECT_NEAR(relative_mse(picture, reference), 0.012633681006642045, 1e-8);
  const Image codes = screen_codes(picture), reference_codes = screen_codes(reference);
  EXPECT_NEAR(psnr_db(codes, reference_codes), 29.84223623055155, 1e-4);
  EXPECT_NEAR(ssim(codes, reference_codes).value(), 0.9539151246745816, 1e-6);
  const Image map = flip_map(picture, reference);
  EXPECT_NEAR(mean_of(map), 0.07551475614309311, 2e-6);
  EXPECT_NEAR(*map.at(0, 0), 0.04339747, 1e-5);
  EXPECT_NEAR(*map.at(27, 20), 0.51387507, 1e-5);
  EXPECT_NEAR(*map.at(20, 12), 0.31807745, 1e-5);
  EXPECT_NEAR(*map.at(50, 40), 0.01394212, 1e-5);
}

TEST(Compare, HasTheNumbersOfClosedForms) {
  // Halfway between 0 and 1 everywhere.
  Image half(20, 20, 3), black(20, 20, 3);
  std::fill(half.pixels.begin(), half.pixels.end(), 0.5f);
  EXPECT_NEAR(relative_mse(half, black), 0.25 / 0.01, 1e-6);
  EXPECT_NEAR(relative_mse(black, half), 0.25 / 0.26, 1e-9);
  EXPECT_NEAR(psnr_db(half, black), 10 * std::log10(4.0), 1e-9);
  EXPECT_NEAR(ssim(half, black).value(), 0.0001 / (0.25 + 0.0001), 1e-6);
  // Black beside white is the largest error that the paper's redistribution allows for grey.
  Image white(20, 20, 3);
  std::fill(white.pixels.begin(), white.pixels.end(), 1.0f);
  EXPECT_GT(mean_of(flip_map(white, black)), 0.9);
  EXPECT_LE(mean_of(flip_map(white, black)), 1);
}

TEST(Compare, APictureIsLikeItself) {
  const Image picture = image_of(picture_code);
  EXPECT_EQ(relative_mse(picture, picture), 0);
  EXPECT_EQ(psnr_db(picture, picture), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(ssim(picture, picture).value(), 1, 1e-12);
  EXPECT_EQ(mean_of(flip_map(picture, picture)), 0);
}

TEST(Compare, TinyPictures) {
  const Image one(1, 1, 3), other = image_of(picture_code);
  EXPECT_FALSE(ssim(one, one).has_value());
  EXPECT_EQ(mean_of(flip_map(one, one)), 0);
  EXPECT_THROW(relative_mse(one, other), std::invalid_argument);
  EXPECT_THROW(flip_map(one, other), std::invalid_argument);
  EXPECT_THROW(flip_map(Image(4, 4, 1), Image(4, 4, 1)), std::invalid_argument);
  EXPECT_THROW(psnr_db(Image(4, 4, 1), Image(4, 4, 3)), std::invalid_argument);
}

}  // namespace
}  // namespace boxwood::render
