// The bar as a terminal gets it.
#include "progress_bar.h"

#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

namespace boxwood::app {
namespace {

const std::string kStartOfLine = "\r\033[K";  // go there, and clear what the line held

/// What a terminal of so many columns is told to show on its line, one text after another.
std::vector<std::string> shown_on(unsigned short columns, const std::function<void(ProgressBar&)>& work) {
  winsize size{};
  size.ws_row = 24;
  size.ws_col = columns;
  int terminal = -1, program = -1;
  EXPECT_EQ(openpty(&terminal, &program, nullptr, nullptr, &size), 0);
  const int stderr_before = dup(STDERR_FILENO);
  dup2(program, STDERR_FILENO);
  {
    ProgressBar bar(false);
    work(bar);
  }
  dup2(stderr_before, STDERR_FILENO);
  close(stderr_before);

  // What was written comes in pieces, and then an error, because nobody is left to write.
  close(program);
  std::string text;
  char bytes[1000];
  for (ssize_t count; (count = read(terminal, bytes, sizeof(bytes))) > 0;)
    text.append(bytes, static_cast<std::size_t>(count));
  close(terminal);
  std::vector<std::string> lines;
  for (std::size_t at = text.find(kStartOfLine); at != std::string::npos;) {
    at += kStartOfLine.size();
    const std::size_t next = text.find(kStartOfLine, at);
    lines.push_back(text.substr(at, next == std::string::npos ? next : next - at));
    at = next;
  }
  return lines;
}

void half_done(ProgressBar& bar) {
  bar.update("rendering", 0.5, "0.54 Mrays/s");
}

TEST(ProgressBar, ForecastsFromWhereTheWorkWasGoneOnWith) {
  // A hundredth took half a second at least, and nine more are left.
  const std::vector<std::string> lines = shown_on(80, [](ProgressBar& bar) {
    bar.update("rendering", 0.90);
    std::this_thread::sleep_for(std::chrono::milliseconds(510));
    bar.update("rendering", 0.91);
  });
  ASSERT_EQ(lines.size(), 3u);
  const std::size_t at = lines[1].find("91%  ");
  ASSERT_NE(at, std::string::npos) << lines[1];
  EXPECT_GE(std::stoi(lines[1].substr(at + 5)), 5) << lines[1];
}

TEST(ProgressBar, ShowsABarAndRemovesIt) {
  const std::vector<std::string> lines = shown_on(80, half_done);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0], "rendering [" + std::string(20, '#') + std::string(20, '.') + "]  50%  0.54 Mrays/s");
  EXPECT_EQ(lines[1], "");
}

TEST(ProgressBar, NeverWrapsTheLine) {
  for (const unsigned short columns : {1, 10, 20, 30, 40, 50}) {
    const std::vector<std::string> lines = shown_on(columns, half_done);
    ASSERT_EQ(lines.size(), 2u) << columns;
    EXPECT_LT(lines[0].size(), columns);
    EXPECT_EQ(lines[0].substr(0, 9), std::string("rendering").substr(0, columns - 1u));
  }
}

}  // namespace
}  // namespace boxwood::app
