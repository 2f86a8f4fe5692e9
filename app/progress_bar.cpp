#include "progress_bar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "console.h"

namespace boxwood::app {
namespace {

constexpr double kBarInterval = 0.1, kLineInterval = 5;  // seconds
constexpr double kSureAfter = 0.5;                       // seconds before a forecast is worth something

/// Columns of the terminal behind stderr.
std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

ProgressBar::ProgressBar(bool is_quiet)
    : style_(is_quiet                ? Style::silent
             : isatty(STDERR_FILENO) ? Style::bar
                                     : Style::lines) {}

void ProgressBar::update(std::string_view stage, double done, std::string_view detail) {
  if (style_ == Style::silent) return;
  const auto now = Clock::now();
  const auto seconds_since = [now](Clock::time_point then) {
    return std::chrono::duration<double>(now - then).count();
  };

  // A new stage starts its own clock.
  // The first line about it waits for its interval; the bar appears at once.
  if (stage != stage_) {
    stage_ = stage;
    stage_start_ = last_shown_ = now;
    done_at_start_ = done;
    if (style_ == Style::lines) return;
  } else if (seconds_since(last_shown_) < (style_ == Style::bar ? kBarInterval : kLineInterval)) {
    return;
  }
  last_shown_ = now;

  done = std::clamp(done, 0.0, 1.0);
  const double elapsed = seconds_since(stage_start_);
  std::string tail = fmt::format("{:3.0f}%", std::floor(100 * done));
  if (!detail.empty()) tail += fmt::format("  {}", detail);
  const double newly_done = done - done_at_start_;
  if (elapsed > kSureAfter && newly_done > 0)
    tail += fmt::format("  {} left", format_duration(elapsed / newly_done * (1 - done)));

  if (style_ == Style::lines) {
    print_error("{} {}\n", stage_, tail);
    return;
  }
  // The bar takes what the words leave of the line. A line that wraps could not be drawn over, so a narrow
  // terminal gets no bar and as many of the words as it has room for.
  const std::size_t words = stage_.size() + tail.size() + 6, columns = terminal_width();
  const std::size_t cells = columns > words + 5 ? std::min<std::size_t>(columns - words, 40) : 0;
  const auto full = static_cast<std::size_t>(done * static_cast<double>(cells));
  const std::string bar =
      cells > 0 ? fmt::format("[{}{}] ", std::string(full, '#'), std::string(cells - full, '.')) : "";
  print_error("\r\033[K{:.{}}", fmt::format("{} {}{}", stage_, bar, tail), columns - 1);
  std::fflush(stderr);
  is_drawn_ = true;
}

void ProgressBar::clear() {
  if (!is_drawn_) return;
  print_error("\r\033[K");
  std::fflush(stderr);
  is_drawn_ = false;
}

std::string format_duration(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(std::min(seconds, 1e9)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace boxwood::app
