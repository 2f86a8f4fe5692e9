// What is written stands there whole, or nothing has changed.
#include "boxwood/io/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "boxwood/core/error.h"
#include "io/files.h"

namespace {
int times_waited = 0;
}

// The program's own function takes the place of the system's: it tells how often the disk was waited for.
extern "C" int fsync(int) {
  ++times_waited;
  return 0;
}

namespace boxwood::io {
namespace {

using WholeFiles = Files;

TEST_F(WholeFiles, WaitForTheDiskWhereTheyMustLast) {
  times_waited = 0;
  write_file(path("result.exr"), "text");
  EXPECT_EQ(times_waited, 2);  // for the file, and for its name
  write_file(path("preview.png"), "text", Lasting::no);
  EXPECT_EQ(times_waited, 2);
  EXPECT_EQ(read_file(path("preview.png")), "text");
  EXPECT_EQ(file_count(), 2u);
}

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

TEST_F(WholeFiles, PartsOfKilledProgramsGoAndNothingElse) {
  for (const char* name : {"a.exr.part12-0", "a.exr.part99999-17"}) write(name, "torn");
  for (const char* name : {"a.exr", "a.exr.part", "a.exr.part12", "a.exr.part-1", "a.exr.part12-",
                           "a.exr.part1-2.exr", "a.exr.partial-2", "b.exr.part12-0"})
    write(name, "somebody's");
  remove_parts(path("a.exr"));
  EXPECT_EQ(file_count(), 8u);
  EXPECT_FALSE(std::filesystem::exists(path("a.exr.part12-0")));
  EXPECT_FALSE(std::filesystem::exists(path("a.exr.part99999-17")));
}

TEST_F(WholeFiles, PiecesBecomeOneFileOrNone) {
  write_file(path("a"), [](const ByteSink& sink) {
    sink("one ");
    sink("two");
  });
  EXPECT_EQ(read(path("a")), "one two");
  EXPECT_THROW(write_file(path("a"),
                          [](const ByteSink& sink) {
                            sink("three");
                            throw std::runtime_error("no more");
                          }),
               std::runtime_error);
  EXPECT_EQ(read(path("a")), "one two");
  EXPECT_EQ(file_count(), 1u);
}

}  // namespace
}  // namespace boxwood::io
