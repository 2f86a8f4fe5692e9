// running.h: how does long work run under Python?
//
// Without the GIL, on the threads that the caller allows, and so that Ctrl-C ends it: Python delivers signals
// to its main thread when that asks for them, so the thread that called asks now and then.
#pragma once

#include <chrono>
#include <functional>

#include <nanobind/nanobind.h>

#include "boxwood/core/parallel.h"
#include "boxwood/core/progress.h"
#include "boxwood/scene/stream.h"

namespace boxwood::python {

namespace nb = nanobind;

/// What the argument `threads` of a call asks for. Executors are made once for each number of threads and
/// kept. Throws ValueError outside of 0 to 1024, TypeError for what is no integer.
Executor& executor_of(nb::handle threads);

/// Asks Python for signals, at most every 20 ms. For the calling thread alone.
class Signals {
 public:
  /// False when a signal's handler has raised; the error is then set. Call without the GIL.
  bool keep_going();

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Calls work(stream) without the GIL; what a signal raised in the meantime is thrown.
void run_stream(std::size_t count, nb::handle threads, const std::function<void(const Stream&)>& work);

/// Calls work(begin, end) for parts of [0, count), likewise.
void run_in_parts(std::size_t count, nb::handle threads, const Executor::Range& work);

/// Calls work(progress) without the GIL, on a thread of its own when `is_long`, so that this one can wait for
/// signals; after one, `progress` returns false.
void run_interruptibly(bool is_long, const std::function<void(const Progress&)>& work);

}  // namespace boxwood::python
