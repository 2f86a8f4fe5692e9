#include "text_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "boxwood/core/error.h"

namespace boxwood::app {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class TextFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  std::ptrdiff_t files() const { return std::distance(fs::directory_iterator(folder_), {}); }

  fs::path folder_ = fs::path(testing::TempDir()) / "boxwood_text_file_test";
};

TEST_F(TextFile, ReplacesWhatWasThere) {
  write_text(folder_ / "a.json", "a much longer text");
  write_text(folder_ / "a.json", "short\n");
  EXPECT_EQ(read(folder_ / "a.json"), "short\n");
  EXPECT_EQ(files(), 1);
}

TEST_F(TextFile, LeavesNothingBehindWhenItFails) {
  fs::create_directories(folder_ / "taken" / "inside");
  EXPECT_THROW(write_text(folder_ / "taken", "text"), FileError);
  EXPECT_THROW(write_text(folder_ / "missing" / "a.json", "text"), FileError);
  EXPECT_EQ(files(), 1);
}

}  // namespace
}  // namespace boxwood::app
