// parallel.h: who does the work?
//
// The library never starts a thread by itself: whatever can run in parallel takes an Executor. Ours run on
// oneTBB or on the calling thread alone; a caller with a task system of their own derives one. No result
// depends on which.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace boxwood {

/// Runs loops and pairs of tasks.
/// All members may be called from several threads and from inside a running task.
class Executor {
 public:
  using Range = std::function<void(std::size_t begin, std::size_t end)>;
  using Task = std::function<void()>;

  virtual ~Executor() = default;
  /// How many threads may work at once; at least 1.
  virtual int concurrency() const = 0;
  /// Covers [begin, end) by calls of `body` on parts of at most `grain` items, in any order, on any thread,
  /// and returns when all are done. An exception from `body` is thrown again here; parts not yet begun may be
  /// left out.
  virtual void for_range(std::size_t begin, std::size_t end, std::size_t grain, const Range& body) = 0;
  /// Runs both tasks, perhaps at the same time, and returns when both are done. Exceptions as in for_range.
  virtual void both(const Task& first, const Task& second) = 0;
};

/// The calling thread and nothing else.
Executor& serial_executor();

/// oneTBB with every thread that the machine offers. oneTBB starts its workers when the first loop runs.
Executor& default_executor();

/// oneTBB with at most `threads` threads, the caller's included; 0 means all. 1 gives a serial executor.
/// Throws std::invalid_argument when `threads` is negative.
std::unique_ptr<Executor> make_executor(int threads);

/// Calls body(i) for each i in [begin, end).
template <class Body>
void parallel_for(Executor& executor, std::size_t begin, std::size_t end, std::size_t grain,
                  const Body& body) {
  executor.for_range(begin, end, grain, [&body](std::size_t b, std::size_t e) {
    for (std::size_t i = b; i < e; ++i) body(i);
  });
}

}  // namespace boxwood
