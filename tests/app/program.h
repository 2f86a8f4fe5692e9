// program.h: what does the program do when a user runs it?
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace boxwood::app {

struct Outcome {
  int exit_code = -1;  ///< 128 + the signal's number when a signal ended it.
  std::string out, err;

  /// How many lines stderr has.
  auto error_lines() const { return std::count(err.begin(), err.end(), '\n'); }
};

/// A folder of its own for each test, gone afterwards.
class ProgramTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / ("boxwood-" + std::string(info->test_suite_name()) +
                                                        "-" + info->name() + "-" + std::to_string(getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Runs `boxwood ARGUMENTS` in a shell, in the test's folder.
  Outcome run(const std::string& arguments) const {
    return run_shell("exec '" BOXWOOD_PROGRAM "' " + arguments);
  }

  Outcome run_shell(const std::string& script) const {
    const std::string command =
        "cd '" + folder_.string() + "' && (" + script + ") >'" + path(".out") + "' 2>'" + path(".err") + "'";
    const int status = std::system(command.c_str());
    Outcome outcome;
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = read(".out");
    outcome.err = read(".err");
    std::filesystem::remove(path(".out"));
    std::filesystem::remove(path(".err"));
    return outcome;
  }

  std::string read(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
  }
  /// Names in the test's folder.
  std::size_t file_count() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator()));
  }

  std::filesystem::path folder_;
};

}  // namespace boxwood::app
