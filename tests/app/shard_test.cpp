// Shards of a farm, and the picture that they make.
#include "boxwood/io/image.h"
#include "program.h"

namespace boxwood::app {
namespace {

class Shards : public ProgramTest {
 protected:
  const std::string picture_ =
      "render stilllife --size 50x30 --samples 20 --layers all --filter mitchell --quiet ";

  void render_shards(int count, const std::string& options = "") const {
    for (int i = 1; i <= count; ++i)
      ASSERT_EQ(run(picture_ + options + "--shard " + std::to_string(i) + "/" + std::to_string(count) +
                    " -o s" + std::to_string(i) + ".exr")
                    .exit_code,
                0);
  }
  void expect_refusal(const std::string& arguments, int exit_code, const std::string& words) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << arguments;
    EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(path("out.exr")));
  }
};

TEST_F(Shards, MergeIntoThePictureOfOneMachine) {
  ASSERT_EQ(run(picture_ + "-o whole.exr").exit_code, 0);
  for (const int count : {2, 3, 7}) {
    render_shards(count);
    // Backward, and on other numbers of threads than the whole.
    std::string files;
    for (int i = count; i >= 1; --i) files += "s" + std::to_string(i) + ".exr ";
    ASSERT_EQ(run("merge " + files + "-o merged.exr --quiet").exit_code, 0);
    EXPECT_FALSE(read("whole.exr").empty());
    EXPECT_TRUE(read("merged.exr") == read("whole.exr")) << count << " shards";
  }
}

TEST_F(Shards, EachIsAPictureOfItsOwn) {
  render_shards(2);
  const Image shard = io::read_exr(path("s1.exr")).image;
  EXPECT_EQ(shard.width, 50);
  EXPECT_EQ(shard.channels, 3 + 14);
  double light = 0;
  for (const float x : shard.pixels) light += x;
  EXPECT_GT(light, 0);
}

TEST_F(Shards, ResumeLikeAnyRender) {
  const std::string shard = "render stilllife --size 50x30 --samples 400 --quiet --shard 2/3 ";
  ASSERT_EQ(run(shard + "-o whole.exr").exit_code, 0);
  const Outcome killed = run_shell("'" BOXWOOD_PROGRAM "' " + shard +
                                   "-o part.exr --checkpoint 0.001 & job=$!; "
                                   "while kill -0 $job 2>/dev/null && [ ! -e part.exr.checkpoint ]; do sleep "
                                   "0.01; done; kill -KILL $job; wait $job");
  ASSERT_EQ(killed.exit_code, 128 + 9) << killed.err;
  ASSERT_EQ(run(shard + "-o part.exr --resume").exit_code, 0);
  EXPECT_TRUE(read("part.exr") == read("whole.exr"));
}

TEST_F(Shards, AreNamedWhenTheyDoNotFit) {
  render_shards(3);
  ASSERT_EQ(run(picture_ + "-o whole.exr").exit_code, 0);
  ASSERT_EQ(run("render stilllife --size 50x30 --samples 21 --shard 1/3 --quiet -o other.exr").exit_code, 0);
  expect_refusal("merge s1.exr s3.exr -o out.exr", 1, "of 3 shards, 2 is missing");
  expect_refusal("merge s2.exr -o out.exr", 1, "of 3 shards, 1, 3 are missing");
  expect_refusal("merge s1.exr s2.exr s1.exr -o out.exr", 1, "s1.exr: is shard 1 of 3 again, as s1.exr");
  expect_refusal("merge s1.exr other.exr -o out.exr", 1,
                 "other.exr: does not belong to the picture of s1.exr (samples: 21, not 20)");
  expect_refusal("merge s1.exr whole.exr -o out.exr", 1, "whole.exr: is not a shard");
  expect_refusal("merge s1.exr nosuch.exr -o out.exr", 1, "nosuch.exr: no such file");
  write("text.exr", "no picture");
  expect_refusal("merge text.exr -o out.exr", 1, "text.exr: is not an OpenEXR file");
  write("torn.exr", read("s2.exr").substr(0, 5000));
  expect_refusal("merge s1.exr torn.exr -o out.exr", 1, "torn.exr");
  expect_refusal("merge -o out.exr", 2, "SHARDS");
  expect_refusal("merge s1.exr s2.exr s3.exr -o no/such/out.exr", 1, "no/such");
}

TEST_F(Shards, RefuseWhatCannotBeShared) {
  for (const std::string shard : {"0/4", "5/4", "4", "a/b", "1/0", "-1/4"})
    expect_refusal("render cornell -o out.exr --shard " + shard, 2, shard);
  expect_refusal("render cornell -o a.png --shard 1/2", 2, "a.png");
  expect_refusal("render cornell -o out.exr --shard 1/2 --noise 0.1", 2, "--noise");
  expect_refusal("render cornell -o out.exr --shard 1/2 --time 5", 2, "--time");
  expect_refusal("render cornell -o out.exr --samples 8 --shard 9/9", 1, "only 8 samples");
}

}  // namespace
}  // namespace boxwood::app
