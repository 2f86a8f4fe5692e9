// Exposure and tone curves.
#include "boxwood/render/tone.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace boxwood::render {
namespace {

Image pixel(float r, float g, float b) {
  Image image(1, 1, 3);
  image.pixels = {r, g, b};
  return image;
}

TEST(Tone, ExposureDoublesLight) {
  EXPECT_EQ(toned(pixel(0.5f, 1, 3), 2, Tone::linear).pixels, (std::vector<float>{2, 4, 12}));
  EXPECT_EQ(toned(pixel(0.5f, 1, 3), 0, Tone::linear).pixels, (std::vector<float>{0.5f, 1, 3}));
}

TEST(Tone, ReinhardKeepsHuesAndMakesFourWhite) {
  EXPECT_NEAR(toned(pixel(4, 4, 4), 0, Tone::reinhard).pixels[0], 1, 1e-6);
  const Image color = toned(pixel(2, 1, 0.5f), 0, Tone::reinhard);
  EXPECT_NEAR(color.pixels[0] / color.pixels[2], 4, 1e-5);
  EXPECT_NEAR(toned(pixel(0.01f, 0.01f, 0.01f), 0, Tone::reinhard).pixels[1], 0.01f, 2e-4f);
}

TEST(Tone, CurvesRiseAndStayFinite) {
  for (const Tone tone : {Tone::linear, Tone::reinhard, Tone::filmic}) {
    float last = -1;
    for (float light = 0; light < 4; light += 0.01f) {
      const float shown = toned(pixel(light, light, light), 0, tone).pixels[0];
      ASSERT_GT(shown, last) << tone_name(tone) << " at " << light;
      last = shown;
    }
    for (const float light : {-1.0f, 1e20f, 3e38f})
      EXPECT_TRUE(std::isfinite(toned(pixel(light, light, light), 0, tone).pixels[0])) << tone_name(tone);
  }
  EXPECT_NEAR(toned(pixel(1e20f, 0, 0), 0, Tone::filmic).pixels[0], 1, 0.04f);
}

TEST(Tone, HasNames) {
  for (const Tone tone : {Tone::linear, Tone::reinhard, Tone::filmic})
    EXPECT_EQ(tone_from_name(tone_name(tone)), tone);
  EXPECT_THROW(tone_from_name("dark"), std::invalid_argument);
}

}  // namespace
}  // namespace boxwood::render
