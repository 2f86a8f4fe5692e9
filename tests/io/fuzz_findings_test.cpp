// What the fuzzers found (tools/fuzz.sh), and what they start from: every file is a scene or a message.
#include <filesystem>

#include "boxwood/io/load.h"
#include "io/files.h"

namespace boxwood::io {
namespace {

TEST(FuzzFindings, EveryFileLoadsOrIsAnErrorOfOneLine) {
  const std::filesystem::path folder = std::filesystem::path(BOXWOOD_SOURCE_FOLDER) / "tests" / "fuzz";
  int files = 0, scenes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || !is_loadable(entry.path())) continue;
    ++files;
    try {
      check(load(entry.path()));
      ++scenes;
    } catch (const FileError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << entry.path();
    }
  }
  EXPECT_GE(files, 8);
  EXPECT_GE(scenes, 8);  // the seeds
}

}  // namespace
}  // namespace boxwood::io
