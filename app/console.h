// console.h: how does the program talk, even when nobody listens?
//
// Streams may be closed, and what stands behind them may be full or gone. A message that cannot be shown
// never costs the work that it is about; a result that was to go to stdout and did not get there is a
// failure.
#pragma once

#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace boxwood::app {

/// Gives stdin, stdout and stderr a place to go when they are closed. Call first of all: a file that is
/// opened later would get their number, and messages meant for the terminal would land in it.
void open_closed_streams();

/// Throws std::runtime_error when something that was printed to stdout did not arrive.
void check_output_arrived();

/// Whether this program talks for itself: of those that mpirun starts together, only rank 0 does.
bool is_heard();

/// Prints to stderr; nothing happens when that fails, or when nobody is to hear it.
template <class... Args>
void print_error(fmt::format_string<Args...> format, Args&&... args) {
  if (!is_heard()) return;
  std::fputs(fmt::format(format, std::forward<Args>(args)...).c_str(), stderr);
}

}  // namespace boxwood::app
