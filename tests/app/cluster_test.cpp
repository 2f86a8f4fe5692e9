// Four ranks under mpirun make the picture that one program makes.
#include "program.h"

namespace boxwood::app {
namespace {

class Ranks : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
#ifndef BOXWOOD_MPIRUN
    GTEST_SKIP() << "Open MPI is not installed";
#endif
  }

#ifdef BOXWOOD_MPIRUN
  /// Starts four ranks on this machine, whatever it has and whoever we are. Each leaves its process id. The
  /// sanitizers are asked about Boxwood, not about what Open MPI keeps until it ends and locks in its own
  /// way.
  static std::string ranks(const std::string& arguments) {
    return "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_plm=isolated "
           "ASAN_OPTIONS=detect_leaks=0 TSAN_OPTIONS=ignore_noninstrumented_modules=1; "
           "'" BOXWOOD_MPIRUN
           "' --oversubscribe --bind-to none -np 4 "
           "sh -c 'echo $$ >rank.$OMPI_COMM_WORLD_RANK; exec \"$0\" \"$@\"' '" BOXWOOD_PROGRAM "' " +
           arguments;
  }
#else
  static std::string ranks(const std::string&) {
    return "false";
  }
#endif

  void expect_same(const std::string& a, const std::string& b) const {
    EXPECT_FALSE(read(a).empty());
    EXPECT_TRUE(read(a) == read(b)) << a << " and " << b;
  }
};

TEST_F(Ranks, MakeThePictureOfOneProgram) {
  for (const std::string budget : {"--samples 24", "--samples 64 --noise 0.2"}) {
    const std::string picture =
        "render stilllife --size 48x32 --layers all --filter mitchell --quiet --threads 1 " + budget + " -o ";
    ASSERT_EQ(run(picture + "whole.exr").exit_code, 0);
    const Outcome outcome = run_shell(ranks(picture + "shared.exr"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "") << "quiet means quiet";
    expect_same("whole.exr", "shared.exr");
  }
}

TEST_F(Ranks, DoNotWaitForOneThatStands) {
  const std::string picture = "render cornell --size 64x64 --samples 200 --quiet --threads 1 -o ";
  ASSERT_EQ(run(picture + "whole.exr").exit_code, 0);
  // One rank stands still from the middle of the render until the picture is there.
  const Outcome outcome = run_shell(
      "(" + ranks(picture + "shared.exr --checkpoint 0.01") +
      ") & job=$!; while [ ! -e shared.exr.checkpoint ] && kill -0 $job; do sleep 0.01; done; "
      "kill -STOP $(cat rank.3); for i in $(seq 6000); do [ -e shared.exr ] && break; sleep 0.01; done; "
      "[ -e shared.exr ] && touch was-there; kill -CONT $(cat rank.3); wait $job");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(path("was-there")));
  expect_same("whole.exr", "shared.exr");
}

TEST_F(Ranks, SpeakWithOneVoice) {
  const Outcome missing = run_shell(ranks("render nosuch.obj -o a.png"));
  EXPECT_EQ(missing.exit_code, 1);
  const Outcome wrong = run_shell(ranks("render --samples 0"));
  EXPECT_EQ(wrong.exit_code, 2);
  for (const auto& [text, words] : {std::pair(missing.err, "boxwood: nosuch.obj: there is no such file"),
                                    std::pair(wrong.err, "boxwood: --samples")}) {
    const std::size_t first = text.find(words);
    EXPECT_NE(first, std::string::npos) << text;
    EXPECT_EQ(text.find("boxwood: ", first + 1), std::string::npos) << text;
  }
}

TEST_F(Ranks, OneThatSeesAnotherSceneIsLeftOut) {
  // Rank 2 finds another file by the same name, as on a host whose disk was not brought up to date.
  write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  std::filesystem::create_directory(folder_ / "old");
  write("old/a.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  const std::string picture = "render a.obj --size 64x64 --samples 100 --quiet --threads 1 -o ";
  ASSERT_EQ(run(picture + "whole.exr").exit_code, 0);
  std::string command = ranks(picture + path("shared.exr"));
  const std::string before = "exec \"$0\"";
  command.insert(command.find(before), "[ $OMPI_COMM_WORLD_RANK = 2 ] && cd old; ");
  const Outcome outcome = run_shell(command);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("rank 2 cannot help: scene: "), std::string::npos) << outcome.err;
  expect_same("whole.exr", "shared.exr");
}

}  // namespace
}  // namespace boxwood::app
