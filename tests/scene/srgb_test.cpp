// The sRGB curve there and back.
#include "boxwood/scene/srgb.h"

#include <gtest/gtest.h>

namespace boxwood {
namespace {

TEST(Srgb, RoundTrip) {
  for (int code = 0; code < 256; ++code)
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(static_cast<float>(code) / 255)),
                static_cast<float>(code) / 255, 1e-5f);
  EXPECT_NEAR(linear_from_srgb(0.5f), 0.21404f, 1e-5f);
}

}  // namespace
}  // namespace boxwood
