// What a render keeps: checkpoints, kills at any moment, disks that are full, previews, budgets.
#include <fstream>

#include <sys/resource.h>

#include "boxwood/io/image.h"
#include "program.h"

namespace boxwood::app {
namespace {

class Keeping : public ProgramTest {
 protected:
  bool same_files(const std::string& a, const std::string& b) const {
    const std::string bytes = read(a);
    return !bytes.empty() && bytes == read(b);
  }
};

// Everything on: adaptive sampling, all layers, a filter with negative lobes, glass, a sun, a lens or not.
const std::string kEverything =
    "stilllife --size 72x40 --samples 64 --noise 0.15 --layers all --filter mitchell --quiet ";

TEST_F(Keeping, KilledAtAnyMomentAndResumedItIsTheSamePicture) {
  ASSERT_EQ(run("render " + kEverything + "-o whole.exr").exit_code, 0);

  // Kill it again and again, each time when it has written one more checkpoint, until it gets through.
  int kills = 0;
  bool is_done = false;
  while (!is_done && kills < 100) {
    const Outcome outcome =
        run_shell("'" BOXWOOD_PROGRAM "' render " + kEverything +
                  "-o part.exr --checkpoint 0.001 --resume --threads " + std::to_string(1 + kills % 3) +
                  " & job=$!; before=$(stat -c %i.%Y.%Z part.exr.checkpoint 2>/dev/null); "
                  "while kill -0 $job 2>/dev/null && "
                  "[ \"$(stat -c %i.%Y.%Z part.exr.checkpoint 2>/dev/null)\" = \"$before\" ]; do "
                  "sleep 0.01; done; sleep 0." +
                  std::to_string(1 + 3 * kills % 7) + "; kill -KILL $job 2>/dev/null; wait $job");
    is_done = outcome.exit_code == 0;
    EXPECT_TRUE(is_done || outcome.exit_code == 128 + 9) << outcome.exit_code << outcome.err;
    kills += is_done ? 0 : 1;
  }
  EXPECT_GE(kills, 1);
  // Where the end of a program takes long, as under a sanitizer, it may never get through.
  if (!is_done) {
    ASSERT_EQ(run("render " + kEverything + "-o part.exr --resume").exit_code, 0);
  }
  EXPECT_TRUE(same_files("whole.exr", "part.exr")) << "after " << kills << " kills";
  EXPECT_EQ(file_count(), 2u) << "the checkpoint goes, and so do parts of it";
}

TEST_F(Keeping, CtrlCLeavesAPictureAndACheckpoint) {
  const std::string arguments = "render cornell --size 48x48 --samples 300 ";
  ASSERT_EQ(run(arguments + "-o whole.exr").exit_code, 0);
  // Pressed when a preview shows that there is something to lose.
  const Outcome stopped = run_shell("'" BOXWOOD_PROGRAM "' " + arguments +
                                    "-o a.exr --checkpoint 0.01 & job=$!; "
                                    "while kill -0 $job 2>/dev/null && [ ! -e a.exr.checkpoint ]; do sleep "
                                    "0.01; done; kill -INT $job; wait $job");
  EXPECT_EQ(stopped.exit_code, 1) << stopped.err;
  EXPECT_NE(stopped.err.find("--resume goes on"), std::string::npos) << stopped.err;
  EXPECT_EQ(io::read_image(path("a.exr")).width, 48);
  const Outcome resumed = run(arguments + "-o a.exr --resume");
  EXPECT_EQ(resumed.exit_code, 0);
  EXPECT_NE(resumed.err.find("going on from a.exr.checkpoint"), std::string::npos) << resumed.err;
  EXPECT_TRUE(same_files("whole.exr", "a.exr"));
  EXPECT_EQ(file_count(), 2u);
}

TEST_F(Keeping, ACheckpointOfAnotherPictureIsRefused) {
  const std::string arguments = "render cornell -o a.exr --size 40x40 --quiet ";
  ASSERT_EQ(run_shell("'" BOXWOOD_PROGRAM "' " + arguments +
                      "--samples 300 --checkpoint 0.001 & job=$!; "
                      "while kill -0 $job 2>/dev/null && [ ! -e a.exr.checkpoint ]; do sleep 0.01; done; "
                      "kill -KILL $job; wait $job")
                .exit_code,
            128 + 9);
  const auto says = [&](const std::string& command, const std::string& words) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 1) << command;
    EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
    EXPECT_NE(outcome.err.find("a.exr.checkpoint"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << command << "\n" << outcome.err;
  };
  const std::string resume = arguments + "--resume ";
  says(resume + "--samples 301", "samples: 300, not 301");
  says(resume + "--samples 300 --filter box", "filter: tent, not box");
  says(resume + "--samples 300 --bounces 3", "bounces: 64, not 3");
  says(resume + "--samples 300 --layers depth", "layers: none, not depth");
  says(resume + "--samples 300 --noise 0.1", "noise: 0, not 0.1");
  says("render cornell -o a.exr --size 41x40 --samples 300 --resume --quiet", "size: 40x40, not 41x40");
  says("render spheres:9 -o a.exr --size 40x40 --samples 300 --resume --quiet", "scene: ");

  // Damage of every kind, anywhere.
  const std::string good = read("a.exr.checkpoint");
  for (const std::size_t size : {std::size_t{1}, std::size_t{30}, good.size() / 2, good.size() - 1}) {
    write("a.exr.checkpoint", good.substr(0, size));
    says(resume + "--samples 300", "checkpoint");
  }
  for (const std::size_t at : {std::size_t{3}, good.size() / 3, good.size() - 9}) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 16);
    write("a.exr.checkpoint", bad);
    says(resume + "--samples 300", "checkpoint");
  }
  write("a.exr.checkpoint", good + "!");
  says(resume + "--samples 300", "damaged");
  EXPECT_FALSE(std::filesystem::exists(path("a.exr")));
}

TEST_F(Keeping, ResumingWithoutACheckpointStartsAtTheBeginning) {
  const Outcome outcome = run("render cornell -o a.png --size 8x8 --samples 1 --resume");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("there is no a.png.checkpoint"), std::string::npos) << outcome.err;
}

TEST_F(Keeping, ADiskThatFillsUpLosesNothing) {
  // No file may grow beyond 4 KB here, and the folder for temporary files is one that takes nothing.
  const std::string arguments = "render cornell --size 60x60 --samples 2 --quiet -o ";
  ASSERT_EQ(run(arguments + "whole.exr").exit_code, 0);
  const Outcome nowhere =
      run_shell("ulimit -f 8; TMPDIR=/proc exec '" BOXWOOD_PROGRAM "' " + arguments + "a.exr");
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_EQ(nowhere.error_lines(), 1) << nowhere.err;
  EXPECT_NE(nowhere.err.find("a.exr: cannot be written: File too large"), std::string::npos) << nowhere.err;
  EXPECT_EQ(file_count(), 1u) << "no part of a file is left";

  // Where there is another place, the picture goes there.
  std::filesystem::create_directory(folder_ / "temp");
  std::filesystem::create_symlink("/dev/full", folder_ / "full.exr");
  const Outcome full =
      run_shell("TMPDIR='" + path("temp") + "' exec '" BOXWOOD_PROGRAM "' " + arguments + "full.exr");
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_EQ(full.error_lines(), 1) << full.err;
  EXPECT_NE(full.err.find("full.exr: cannot be written: No space left on device; the picture is in "),
            std::string::npos)
      << full.err;
  std::string rescued;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "temp"))
    if (entry.is_regular_file()) rescued = std::filesystem::relative(entry.path(), folder_).string();
  EXPECT_TRUE(same_files("whole.exr", rescued)) << rescued;
}

TEST_F(Keeping, ACheckpointThatFindsNoRoomIsAWarning) {
  std::filesystem::create_symlink("/dev/full", folder_ / "a.exr.checkpoint");
  const Outcome outcome =
      run("render cornell --size 40x40 --samples 200 -o a.exr --checkpoint 0.001 --quiet");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: a.exr.checkpoint: cannot be written: No space left"),
            std::string::npos)
      << outcome.err;
  EXPECT_EQ(io::read_image(path("a.exr")).width, 40);
}

TEST_F(Keeping, APreviewAppearsBeforeThePicture) {
  const Outcome outcome =
      run_shell("'" BOXWOOD_PROGRAM
                "' render cornell -o a.exr --size 64x64 --samples 1000000 --preview look.png "
                "& job=$!; while kill -0 $job 2>/dev/null && [ ! -e look.png ]; do sleep 0.05; done; "
                "[ ! -e a.exr ] && cp look.png early.png; kill -INT $job; wait $job");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(io::read_image(path("early.png")).width, 64);
}

TEST_F(Keeping, ATimeBudgetEndsWithAWholePicture) {
  // However short the time: one sample for each pixel, and done.
  const Outcome outcome = run("render cornell -o a.exr --size 50x50 --time 0.001 --layers samples");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Image image = io::read_image(path("a.exr"));
  for (int i = 0; i < 50 * 50; ++i) ASSERT_GE(image.pixels[i * 4 + 3], 1);
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(Keeping, MemoryDoesNotGrowWithSamples) {
  // The most that the program ever held, in KB, as the kernel tells of each child that it waits for.
  const auto most_kb = [&](const char* samples) {
    const std::string picture = path(std::string(samples) + ".exr");
    const pid_t child = fork();
    if (child == 0) {
      setenv("ASAN_OPTIONS", "quarantine_size_mb=1", 1);  // what is freed is to be free there, too
      execl(BOXWOOD_PROGRAM, "boxwood", "render", "cornell", "--size", "40x40", "--samples", samples,
            "--threads", "1", "--quiet", "-o", picture.c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    int status = -1;
    rusage usage{};
    EXPECT_EQ(wait4(child, &status, 0, &usage), child);
    EXPECT_EQ(status, 0);
    return usage.ru_maxrss;
  };
  const long few = most_kb("32");
  EXPECT_LT(most_kb("1024"), few + 8192) << few;  // 19 MB if each sample were kept
}

TEST_F(Keeping, SeveralOutputsOfOneRender) {
  const Outcome outcome =
      run("render cornell -o a.exr -o a.png -o a.hdr --size 30x20 --samples 4 --layers all --half --exposure "
          "1 --tone filmic");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(io::read_image(path("a.exr")).channels, 3 + 14);
  EXPECT_EQ(io::read_image(path("a.png")).channels, 3);
  EXPECT_EQ(io::read_image(path("a.hdr")).channels, 3);
}

TEST_F(Keeping, ExposureChangesPngAlone) {
  const std::string arguments = "render cornell --size 16x16 --samples 4 --quiet ";
  ASSERT_EQ(run(arguments + "-o a.exr -o a.png").exit_code, 0);
  ASSERT_EQ(run(arguments + "-o b.exr -o b.png --exposure -1").exit_code, 0);
  EXPECT_TRUE(same_files("a.exr", "b.exr"));
  const Image a = io::read_image(path("a.png")), b = io::read_image(path("b.png"));
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (a.pixels[i] < 0.99f) {
      EXPECT_NEAR(b.pixels[i], a.pixels[i] / 2, 0.01f);
    }
  }
}

}  // namespace
}  // namespace boxwood::app
