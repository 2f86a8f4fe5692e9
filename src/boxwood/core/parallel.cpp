#include "boxwood/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#if !defined(__EMSCRIPTEN__)
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>
#endif

namespace boxwood {
namespace {

class SerialExecutor : public Executor {
 public:
  int concurrency() const override { return 1; }
  void for_range(std::size_t begin, std::size_t end, std::size_t grain, const Range& body) override {
    for (grain = std::max<std::size_t>(grain, 1); begin < end;) {
      const std::size_t stop = end - begin > grain ? begin + grain : end;
      body(begin, stop);
      begin = stop;
    }
  }
  void both(const Task& first, const Task& second) override {
    first();
    second();
  }
};

#if defined(__EMSCRIPTEN__)

/// A web page has one thread, and no oneTBB.
class ParallelExecutor final : public SerialExecutor {
 public:
  explicit ParallelExecutor(int) {}
};

#elif defined(__SANITIZE_THREAD__)

/// Plain threads in place of oneTBB's under the thread sanitizer, which cannot follow a oneTBB that is not
/// built with it (Debian's is not), and would report every task. With these it sees each fork and each join,
/// and every race of ours.
class ParallelExecutor final : public Executor {
 public:
  explicit ParallelExecutor(int threads) : threads_(threads > 0 ? threads : 4) {}
  int concurrency() const override { return threads_; }
  void for_range(std::size_t begin, std::size_t end, std::size_t grain, const Range& body) override {
    if (begin >= end) return;
    if (end - begin <= std::max<std::size_t>(grain, 1)) return body(begin, end);
    const std::size_t middle = begin + (end - begin) / 2;
    both([&] { for_range(begin, middle, grain, body); }, [&] { for_range(middle, end, grain, body); });
  }
  void both(const Task& first, const Task& second) override {
    // Take a helper while one is free.
    // Relaxed, so that the count itself puts nothing in order and hides no race.
    if (helpers_.fetch_add(1, std::memory_order_relaxed) >= threads_ - 1) {
      helpers_.fetch_sub(1, std::memory_order_relaxed);
      first();
      second();
      return;
    }
    std::exception_ptr errors[2];
    const auto run = [](const Task& task, std::exception_ptr& error) {
      try {
        task();
      } catch (...) {
        error = std::current_exception();
      }
    };
    std::thread helper([&] { run(second, errors[1]); });
    run(first, errors[0]);
    helper.join();
    helpers_.fetch_sub(1, std::memory_order_relaxed);
    for (const std::exception_ptr& error : errors)
      if (error) std::rethrow_exception(error);
  }

 private:
  int threads_;
  std::atomic<int> helpers_{0};
};

#else

class ParallelExecutor final : public Executor {
 public:
  /// 0 threads means all that the machine offers.
  explicit ParallelExecutor(int threads) {
    // oneTBB keeps to the number of cores, and prints a warning, unless more threads are allowed first.
    if (threads > tbb::info::default_concurrency())
      allowance_.emplace(tbb::global_control::max_allowed_parallelism, threads);
    if (threads > 0)
      arena_.initialize(threads);
    else
      arena_.initialize();
  }
  int concurrency() const override { return arena_.max_concurrency(); }
  void for_range(std::size_t begin, std::size_t end, std::size_t grain, const Range& body) override {
    if (begin >= end) return;
    arena_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(begin, end, std::max<std::size_t>(grain, 1)),
          [&](const tbb::blocked_range<std::size_t>& r) { body(r.begin(), r.end()); },
          tbb::simple_partitioner());
    });
  }
  void both(const Task& first, const Task& second) override {
    arena_.execute([&] { tbb::parallel_invoke(first, second); });
  }

 private:
  std::optional<tbb::global_control> allowance_;
  mutable tbb::task_arena arena_;
};

#endif

}  // namespace

Executor& serial_executor() {
  static SerialExecutor executor;
  return executor;
}

Executor& default_executor() {
  static ParallelExecutor executor(0);
  return executor;
}

std::unique_ptr<Executor> make_executor(int threads) {
  if (threads < 0)
    throw std::invalid_argument("make_executor: threads is " + std::to_string(threads) +
                                ", expected 0 or more");
  if (threads == 1) return std::make_unique<SerialExecutor>();
  return std::make_unique<ParallelExecutor>(threads);
}

}  // namespace boxwood
