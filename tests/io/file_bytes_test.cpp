// What is written stands there whole, or nothing has changed.
#include "boxwood/io/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "boxwood/core/error.h"
#include "io/files.h"

namespace boxwood::io {
namespace {

using WholeFiles = Files;

TEST_F(WholeFiles, ReplaceWhatWasThere) {
  write_file(path("a.json"), "a much longer text");
  write_file(path("a.json"), "short\n");
  EXPECT_EQ(read_file(path("a.json")), "short\n");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(WholeFiles, LeaveNothingBehindWhenTheyCannotBe) {
  std::filesystem::create_directories(path("taken") / "inside");
  EXPECT_THROW(write_file(path("taken"), "text"), FileError);
  EXPECT_THROW(write_file(path("missing") / "a.json", "text"), FileError);
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(WholeFiles, LinksStayLinks) {
  write("behind.json", "old");
  std::filesystem::create_symlink("behind.json", path("link.json"));
  write_file(path("link.json"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.json")));
  EXPECT_EQ(read_file(path("behind.json")), "new");
  EXPECT_EQ(file_count(), 2u);
}

TEST_F(WholeFiles, PipesStayPipesAndDevicesDevices) {
  // A pipe that holds what was written until it is read; opened for both, so that nobody waits.
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const int pipe = ::open(path("pipe").c_str(), O_RDWR);
  ASSERT_GE(pipe, 0);
  write_file(path("pipe"), "text");
  char bytes[5] = {};
  ASSERT_TRUE(std::filesystem::is_fifo(path("pipe")));
  EXPECT_EQ(::read(pipe, bytes, 4), 4);
  EXPECT_STREQ(bytes, "text");
  ::close(pipe);

  // Through links of our own: a mistake replaces the link and not the machine's device.
  std::filesystem::create_symlink("/dev/null", path("null"));
  std::filesystem::create_symlink("/dev/full", path("full"));
  write_file(path("null"), "text");
  EXPECT_TRUE(std::filesystem::is_character_file(path("null")));
  EXPECT_THROW(write_file(path("full"), "text"), FileError);
  EXPECT_TRUE(std::filesystem::is_character_file(path("full")));
  EXPECT_EQ(file_count(), 3u);
}

}  // namespace
}  // namespace boxwood::io
