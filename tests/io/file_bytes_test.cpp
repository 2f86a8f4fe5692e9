// What is written stands there whole, or nothing has changed.
#include "boxwood/io/file_bytes.h"

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

}  // namespace
}  // namespace boxwood::io
