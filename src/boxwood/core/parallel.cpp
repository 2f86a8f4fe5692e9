#include "boxwood/core/parallel.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

namespace boxwood {
namespace {

class SerialExecutor final : public Executor {
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

class TbbExecutor final : public Executor {
 public:
  /// 0 threads means all that the machine offers.
  explicit TbbExecutor(int threads) {
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
          [&](const tbb::blocked_range<std::size_t>& r) { body(r.begin(), r.end()); }, tbb::simple_partitioner());
    });
  }
  void both(const Task& first, const Task& second) override {
    arena_.execute([&] { tbb::parallel_invoke(first, second); });
  }

 private:
  std::optional<tbb::global_control> allowance_;
  mutable tbb::task_arena arena_;
};

}  // namespace

Executor& serial_executor() {
  static SerialExecutor executor;
  return executor;
}

Executor& default_executor() {
  static TbbExecutor executor(0);
  return executor;
}

std::unique_ptr<Executor> make_executor(int threads) {
  if (threads < 0) throw std::invalid_argument("make_executor: threads is " + std::to_string(threads) + ", expected 0 or more");
  if (threads == 1) return std::make_unique<SerialExecutor>();
  return std::make_unique<TbbExecutor>(threads);
}

}  // namespace boxwood
