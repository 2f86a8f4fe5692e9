// The program as a user meets it: exit codes, one line for what went wrong, and nothing half-written.
#include "program.h"

#include <sstream>

#include "boxwood/io/image.h"

namespace boxwood::app {
namespace {

class Program : public ProgramTest {
 protected:
  /// One clear line on stderr, nothing on stdout, no file left.
  void expect_refusal(const std::string& arguments, int exit_code, const std::string& expected_words,
                      std::size_t files = 0) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.error_lines(), 1) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.err.rfind("boxwood: ", 0), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find(expected_words), std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(file_count(), files) << arguments;
  }
};

TEST_F(Program, HelpAndVersion) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command : {"render", "info", "ladder", "bench", "Examples"})
    EXPECT_NE(help.out.find(command), std::string::npos);
  const Outcome render_help = run("render --help");
  EXPECT_EQ(render_help.exit_code, 0);
  for (const char* word : {"--size", "--samples", "--noise", "--time", "--resume", "--shard", "--layers",
                           "--filter", "--mode", "--threads", "--quiet", "stilllife", "Examples"})
    EXPECT_NE(render_help.out.find(word), std::string::npos) << word;
  const Outcome version = run("--version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out.rfind("boxwood ", 0), 0u);
}

TEST_F(Program, WrongUsageIsCodeTwo) {
  expect_refusal("", 2, "subcommand");
  expect_refusal("paint", 2, "'paint'");
  expect_refusal("render --mode fog", 2, "fog");
  expect_refusal("render --samples 0", 2, "--samples");
  expect_refusal("render --samples many", 2, "many");
  expect_refusal("render --size 640", 2, "640");
  expect_refusal("render --size 640x", 2, "640x");
  expect_refusal("render --size -5x5", 2, "-5x5");
  expect_refusal("render --size 5x5x5", 2, "5x5x5");
  expect_refusal("render --threads -1", 2, "--threads");
  expect_refusal("render --build worst", 2, "worst");
  expect_refusal("render cornell -o picture.jpg", 2, ".png");
  expect_refusal("render cornell -o picture", 2, ".png");
  expect_refusal("render cornell --color blue", 2, "--color");
  expect_refusal("render cornell cornell -o a.png", 2, "cornell");
  expect_refusal("render --noise 0", 2, "--noise");
  expect_refusal("render --time -1", 2, "--time");
  expect_refusal("render --bounces 65", 2, "65");
  expect_refusal("render --bounces -1", 2, "-1");
  expect_refusal("render --bounces 4.5", 2, "4.5");
  expect_refusal("render --filter round", 2, "round");
  expect_refusal("render --layers fog -o a.exr", 2, "fog");
  expect_refusal("render --layers depth -o a.png", 2, "--layers");
  expect_refusal("render --tone dark", 2, "dark");
  expect_refusal("render --preview a.txt", 2, "a.txt");
  expect_refusal("render --checkpoint often", 2, "often");
}

TEST_F(Program, ImpossibleSizesAreRefusedBeforeAnyWork) {
  expect_refusal("render cornell -o a.png --size 0x0", 1, "0x0");
  expect_refusal("render cornell -o a.png --size 0x100", 1, "0x100");
  expect_refusal("render cornell -o a.png --size 1000000000x1000000000", 1, "size");
  expect_refusal("render cornell -o a.png --size 1x1000000000", 1, "size");
  expect_refusal("render cornell -o a.png --size 99999999999999999999x2", 1, "size");
}

TEST_F(Program, OutputThatCannotBeWrittenIsFoundOutFirst) {
  // The scene would take for ever; the answer comes at once.
  expect_refusal("render soup:1000000 -o no/such/folder/a.png --samples 100000", 1, "no/such/folder");
  std::filesystem::create_directory(folder_ / "a.png");
  expect_refusal("render cornell -o a.png", 1, "a.png", 1);
  write("file", "");
  expect_refusal("render cornell -o file/a.png", 1, "file", 2);
  expect_refusal("render cornell -o /proc/a.png", 1, "/proc", 2);
}

TEST_F(Program, ScenesThatAreNotThere) {
  expect_refusal("render nosuch.obj -o a.png", 1, "nosuch.obj");
  expect_refusal("render nosuch -o a.png", 1, "stilllife");  // lists what there is
  expect_refusal("render spheres:many -o a.png", 1, "many");
  expect_refusal("render cornell:3 -o a.png", 1, "cornell");
  expect_refusal("render . -o a.png", 1, ".");
}

TEST_F(Program, SaysWhichKernelsRun) {
  const Outcome scalar = run_shell("BOXWOOD_TARGET=scalar exec '" BOXWOOD_PROGRAM "' info --cpu");
  EXPECT_EQ(scalar.exit_code, 0);
  EXPECT_EQ(scalar.err, "");
  EXPECT_NE(scalar.out.find("plain C++"), std::string::npos) << scalar.out;
  const Outcome best = run_shell("unset BOXWOOD_TARGET; exec '" BOXWOOD_PROGRAM "' info --cpu");
  EXPECT_EQ(best.exit_code, 0);
  EXPECT_NE(best.out.find("running"), std::string::npos) << best.out;
  EXPECT_NE(best.out.find(", scalar\n"), std::string::npos) << best.out;
}

TEST_F(Program, RefusesATargetThatIsNone) {
  for (const std::string command :
       {"info --cpu", "info cornell --quiet", "render cornell -o a.png --quiet"}) {
    const Outcome outcome = run_shell("BOXWOOD_TARGET=mmx exec '" BOXWOOD_PROGRAM "' " + command);
    EXPECT_EQ(outcome.exit_code, 1) << command;
    EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
    EXPECT_EQ(outcome.err.rfind("boxwood: BOXWOOD_TARGET is \"mmx\"; this machine has ", 0), 0u)
        << outcome.err;
  }
}

TEST_F(Program, FilesThatMayNotBeSeen) {
  std::filesystem::create_symlink("loop.obj", folder_ / "loop.obj");
  expect_refusal("info loop.obj", 1, "loop.obj: cannot be read: Too many levels of symbolic links", 1);
}

TEST_F(Program, BrokenFiles) {
  write("broken.obj", "v 0 0 0\nf 1 2 3\n");
  expect_refusal("render broken.obj -o a.png", 1, "broken.obj", 1);
  write("broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
  expect_refusal("render broken.ply -o a.png", 1, "broken.ply", 2);
  write("unknown.xyz", "?");
  expect_refusal("render unknown.xyz -o a.png", 1, "unknown.xyz", 3);
}

TEST_F(Program, RendersEveryModeToEveryFormat) {
  for (const std::string mode : {"path", "color", "normal", "depth", "occlusion", "cost"}) {
    for (const std::string ending : {"png", "exr", "hdr"}) {
      const std::string file = mode + "." + ending;
      const Outcome outcome =
          run("render spheres:20 -o " + file + " --size 40x30 --samples 2 --quiet --mode " + mode);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
      EXPECT_EQ(outcome.err + outcome.out, "") << "quiet means quiet";
      EXPECT_GT(std::filesystem::file_size(folder_ / file), 100u);
    }
  }
  EXPECT_EQ(file_count(), 18u);  // and nothing else
}

TEST_F(Program, TheSamePictureForAnyNumberOfThreads) {
  const std::string arguments = "render cornell --size 60x60 --samples 8 --quiet -o ";
  EXPECT_EQ(run(arguments + "one.exr --threads 1").exit_code, 0);
  EXPECT_EQ(run(arguments + "three.exr --threads 3").exit_code, 0);
  EXPECT_EQ(run("render cornell --size 60x60 --samples 8 --quiet -o best.exr --build best").exit_code, 0);
  // The pixels, not the bytes: the file also holds the time when it was made.
  const auto pixels = [&](const char* name) { return io::read_image(path(name)).pixels; };
  EXPECT_EQ(pixels("one.exr").size(), 60u * 60 * 3);
  EXPECT_TRUE(pixels("one.exr") == pixels("three.exr"));
  EXPECT_TRUE(pixels("one.exr") == pixels("best.exr")) << "nor does it depend on the tree";
}

TEST_F(Program, LightGoesAsFarAsIsAsked) {
  expect_refusal("render cornell -o a.png --bounces file", 1, "cornell does not say");
  write("room.pbrt",
        "Integrator \"path\" \"integer maxdepth\" 2 Camera \"perspective\" WorldBegin\n"
        "AttributeBegin AreaLightSource \"diffuse\" \"bool twosided\" true\n"
        "Material \"diffuse\" \"rgb reflectance\" [.8 .8 .8] Shape \"sphere\" AttributeEnd\n");
  const auto pixels = [&](const std::string& options) {
    EXPECT_EQ(run("render room.pbrt --size 16x16 --samples 4 --quiet -o a.exr " + options).exit_code, 0);
    return io::read_image(path("a.exr")).pixels;
  };
  const auto as_the_file = pixels("--bounces file"), freely = pixels("");
  EXPECT_TRUE(as_the_file == pixels("--bounces 2"));
  EXPECT_TRUE(freely == pixels("--bounces 64"));
  EXPECT_LT(*std::max_element(as_the_file.begin(), as_the_file.end()),
            *std::min_element(freely.begin(), freely.end()));
  EXPECT_NE(run("info room.pbrt").out.find("2 at most"), std::string::npos);
}

TEST_F(Program, SaysWhatItDidUnlessQuiet) {
  const Outcome outcome = run("render spheres:20 -o a.png --size 40x30 --samples 2");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("a.png"), std::string::npos);
  EXPECT_NE(outcome.err.find("rays"), std::string::npos);
  EXPECT_EQ(outcome.err.find('\r'), std::string::npos) << "no bar where there is no terminal";
}

TEST_F(Program, DevicesAndLinksStayWhatTheyAre) {
  std::filesystem::create_symlink("/dev/null", folder_ / "null");
  std::filesystem::create_symlink("/dev/full", folder_ / "full.png");
  EXPECT_EQ(run("info cornell --json null").exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_character_file(folder_ / "null"));
  expect_refusal("render cornell -o full.png --size 8x8 --samples 1 --quiet", 1, "full.png", 2);
  EXPECT_TRUE(std::filesystem::is_character_file(folder_ / "full.png"));
}

TEST_F(Program, WorksWhenNobodyListens) {
  for (const std::string streams : {">&- 2>&- <&-", "2>&-", "2>/dev/full"}) {
    const Outcome outcome = run("render cornell -o a.png --size 8x8 --samples 1 " + streams);
    EXPECT_EQ(outcome.exit_code, 0) << streams;
    EXPECT_EQ(read("a.png").substr(1, 3), "PNG") << streams;
    std::filesystem::remove(folder_ / "a.png");
    EXPECT_EQ(run("render nosuch -o a.png " + streams).exit_code, 1) << streams;
  }
  EXPECT_EQ(run("info cornell | head -n 1").err, "");
}

TEST_F(Program, SaysWhenItsOutputDidNotArrive) {
  expect_refusal("info cornell --quiet >/dev/full", 1, "stdout");
  expect_refusal("--help >/dev/full", 1, "stdout");
}

TEST_F(Program, ManyWarningsDoNotFloodTheTerminal) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 1000; ++i) text += "usemtl unknown" + std::to_string(i) + "\nf 1 2 3\n";
  write("a.obj", text);
  const Outcome outcome = run("info a.obj --quiet");
  EXPECT_EQ(outcome.error_lines(), 21);
  EXPECT_NE(outcome.err.find("980 more"), std::string::npos) << outcome.err;
}

TEST_F(Program, HelpFitsATerminal) {
  for (const std::string command : {"", "render ", "merge ", "diff ", "info ", "ladder "}) {
    std::istringstream help(run(command + "--help").out);
    for (std::string line; std::getline(help, line);) EXPECT_LE(line.size(), 80u) << command << ": " << line;
  }
}

TEST_F(Program, InterruptWritesWhatThereIs) {
  // Not before it renders: a signal that came while it starts would be lost.
  const Outcome outcome =
      run_shell("'" BOXWOOD_PROGRAM
                "' render cornell -o a.png --size 64x64 --samples 1000000 --checkpoint 0.01 & job=$!; "
                "while kill -0 $job 2>/dev/null && [ ! -e a.png.checkpoint ]; do sleep 0.01; done; "
                "kill -INT $job; wait $job");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("stopped"), std::string::npos) << outcome.err;
  EXPECT_GT(std::filesystem::file_size(folder_ / "a.png"), 100u);
  EXPECT_EQ(file_count(), 2u) << "the picture and the checkpoint";
}

}  // namespace
}  // namespace boxwood::app
