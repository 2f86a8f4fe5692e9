// progress_bar.h: how does a user see that long work goes on?
//
// On a terminal by a bar that is drawn over itself, elsewhere by a plain line now and then, and not at all
// when asked to be quiet. Everything goes to stderr.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace boxwood::app {

class ProgressBar {
 public:
  explicit ProgressBar(bool is_quiet);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows that `stage` is done but for 1 - `done`; `detail` (a rate, say) stands behind the percentage.
  /// Cheap: most calls return at once, because nobody can read faster. Call from one thread at a time.
  void update(std::string_view stage, double done, std::string_view detail = {});

  /// Removes the bar from the terminal, so that other lines can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  enum class Style { bar, lines, silent };

  Style style_;
  std::string stage_;
  Clock::time_point stage_start_, last_shown_;
  double done_at_start_ = 0;  // of the stage; work that is gone on with begins in the middle
  bool is_drawn_ = false;
};

/// Seconds as "8 s", "2:05" or "1:02:03".
std::string format_duration(double seconds);

}  // namespace boxwood::app
