// boxwood diff: numbers, a picture, and pictures that cannot be compared.
#include "boxwood/io/image.h"
#include "program.h"

namespace boxwood::app {
namespace {

class Diff : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Image image(16, 12, 3);
    std::fill(image.pixels.begin(), image.pixels.end(), 0.5f);
    io::write_image(path("half.exr"), image);
    image.pixels.assign(image.pixels.size(), 0);
    io::write_image(path("black.exr"), image);
    io::write_image(path("grey.png"), Image(16, 12, 1));
    io::write_image(path("small.exr"), Image(8, 12, 3));
    Image layers(16, 12, 3);
    layers.channel_names = {"normal.X", "normal.Y", "normal.Z"};
    io::write_image(path("layers.exr"), layers);
  }
  void expect_refusal(const std::string& arguments, int exit_code, const std::string& words) const {
    const Outcome outcome = run("diff " + arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << arguments;
    EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find(words), std::string::npos) << arguments << "\n" << outcome.err;
  }
};

TEST_F(Diff, TellsFourNumbersAndDrawsAPicture) {
  const Outcome outcome = run("diff half.exr black.exr -o map.png");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  // 0.25 / 0.01, and the square of the code of 0.5 by sRGB's curve: 0.7354.
  EXPECT_NE(outcome.out.find("relative MSE  25\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("PSNR          2.67 dB\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("SSIM          0.0001"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("FLIP          0.9"), std::string::npos) << outcome.out;
  const Image map = io::read_image(path("map.png"));
  EXPECT_EQ(map.width, 16);
  EXPECT_GT(map.at(5, 5)[0], 0.8f) << "yellow";
}

TEST_F(Diff, SaysWhenPicturesAreTheSame) {
  const Outcome outcome = run("diff half.exr half.exr");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* words : {"relative MSE  0\n", "PSNR          inf dB\n", "SSIM          1.00000\n",
                            "FLIP          0.00000\n", "number for number"})
    EXPECT_NE(outcome.out.find(words), std::string::npos) << outcome.out;
  EXPECT_EQ(run("diff half.exr black.exr").out.find("number for number"), std::string::npos);
}

TEST_F(Diff, ExposureCountsForWhatAScreenShows) {
  // Both are white after ten stops, and as light they are as different as before.
  Image bright(16, 12, 3);
  std::fill(bright.pixels.begin(), bright.pixels.end(), 1.0f);
  io::write_image(path("bright.exr"), bright);
  const Outcome outcome = run("diff bright.exr half.exr --exposure 10");
  EXPECT_NE(outcome.out.find("relative MSE  0.961538\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("FLIP          0.00000\n"), std::string::npos) << outcome.out;
}

TEST_F(Diff, SaysWhyPicturesCannotBeCompared) {
  expect_refusal("half.exr small.exr", 1,
                 "half.exr, small.exr: the pictures differ in shape: 16x12 with 3 channels, and 8x12");
  expect_refusal("half.exr grey.png", 1, "16x12 with 3 channels, and 16x12 with 1 channel");
  expect_refusal("half.exr layers.exr", 1,
                 "layers.exr: has the channels normal.X, normal.Y, normal.Z, expected R, G and B");
  expect_refusal("half.exr nosuch.exr", 1, "nosuch.exr: no such file");
  write("text.png", "no picture");
  expect_refusal("half.exr text.png", 1, "text.png");
  expect_refusal("half.exr", 2, "REFERENCE");
  expect_refusal("half.exr black.exr -o map.gif", 2, "map.gif");
  expect_refusal("half.exr black.exr -o none/map.png", 1, "none");
}

TEST_F(Diff, NumbersThatAreNoneAreCounted) {
  Image image(16, 12, 3);
  image.at(3, 3)[1] = std::numeric_limits<float>::quiet_NaN();
  io::write_image(path("nan.exr"), image);
  const Outcome outcome = run("diff nan.exr black.exr");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("nan.exr: 1 numbers are not finite"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("relative MSE  0\n"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace boxwood::app
