// Executors: everything runs once, exceptions come back, loops nest, and a caller's own one serves as well.
#include "boxwood/core/parallel.h"

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace boxwood {
namespace {

/// A caller's own: a new thread for every second part. Slow, and nothing like ours.
class ThreadPerPart final : public Executor {
 public:
  int concurrency() const override { return 2; }
  void for_range(std::size_t begin, std::size_t end, std::size_t grain, const Range& body) override {
    while (begin < end) {
      const std::size_t middle = std::min(end, begin + grain), stop = std::min(end, middle + grain);
      both([&] { body(begin, middle); },
           [&] {
             if (middle < stop) body(middle, stop);
           });
      begin = stop;
    }
  }
  void both(const Task& first, const Task& second) override {
    std::exception_ptr error;
    std::thread helper([&] {
      try {
        second();
      } catch (...) {
        error = std::current_exception();
      }
    });
    try {
      first();
    } catch (...) {
      helper.join();
      throw;
    }
    helper.join();
    if (error) std::rethrow_exception(error);
  }
};

class EachExecutor : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (GetParam() > 0) made_ = make_executor(GetParam());
    if (GetParam() == -3) made_ = std::make_unique<ThreadPerPart>();
  }
  Executor& executor() {
    if (made_) return *made_;
    return GetParam() == -1 ? serial_executor() : default_executor();
  }

 private:
  std::unique_ptr<Executor> made_;
};
INSTANTIATE_TEST_SUITE_P(Parallel, EachExecutor, ::testing::Values(-1, -2, -3, 1, 2, 8),
                         [](const auto& test) {
                           return test.param == -1   ? std::string("serial")
                                  : test.param == -2 ? std::string("all")
                                  : test.param == -3 ? std::string("callers_own")
                                                     : "threads_" + std::to_string(test.param);
                         });

TEST_P(EachExecutor, CoversEachItemOnceInPartsNoLargerThanTheGrain) {
  for (const std::size_t n : {0, 1, 7, 100, 1000})
    for (const std::size_t grain : {1, 3, 64, 5000}) {
      std::vector<std::atomic<int>> seen(n + 5);
      std::atomic<bool> is_small{true};
      executor().for_range(5, 5 + n, grain, [&](std::size_t begin, std::size_t end) {
        if (end - begin > grain || begin >= end) is_small = false;
        for (std::size_t i = begin; i < end; ++i) ++seen[i];
      });
      EXPECT_TRUE(is_small);
      for (std::size_t i = 0; i < n + 5; ++i) ASSERT_EQ(seen[i], i >= 5 ? 1 : 0);
    }
}

TEST_P(EachExecutor, ABackwardRangeIsNothing) {
  executor().for_range(9, 3, 1, [](std::size_t, std::size_t) { FAIL(); });
}

TEST_P(EachExecutor, RunsBoth) {
  std::atomic<int> sum{0};
  executor().both([&] { sum += 1; }, [&] { sum += 10; });
  EXPECT_EQ(sum, 11);
}

TEST_P(EachExecutor, BringsExceptionsBack) {
  const auto fail_at = [&](std::size_t bad) {
    parallel_for(executor(), 0, 1000, 1, [&](std::size_t i) {
      if (i == bad) throw std::runtime_error("item " + std::to_string(i));
    });
  };
  for (const std::size_t bad : {0, 500, 999}) {
    try {
      fail_at(bad);
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& e) {
      EXPECT_EQ(e.what(), "item " + std::to_string(bad));
    }
  }
  EXPECT_NO_THROW(fail_at(1000));
  EXPECT_THROW(executor().both([] { throw std::logic_error("first"); }, [] {}), std::logic_error);
  EXPECT_THROW(executor().both([] {}, [] { throw std::logic_error("second"); }), std::logic_error);
}

TEST_P(EachExecutor, Nests) {
  std::atomic<int> count{0};
  parallel_for(executor(), 0, 10, 1, [&](std::size_t) {
    executor().both([&] { parallel_for(executor(), 0, 20, 3, [&](std::size_t) { ++count; }); },
                    [&] { parallel_for(executor(), 0, 30, 7, [&](std::size_t) { ++count; }); });
  });
  EXPECT_EQ(count, 500);
}

TEST_P(EachExecutor, ServesSeveralCallersAtOnce) {
  std::atomic<int> count{0};
  std::vector<std::thread> callers;
  for (int i = 0; i < 4; ++i)
    callers.emplace_back([&] { parallel_for(executor(), 0, 100, 10, [&](std::size_t) { ++count; }); });
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(count, 400);
}

TEST(Parallel, ExecutorsSayHowWideTheyAre) {
  EXPECT_EQ(serial_executor().concurrency(), 1);
  EXPECT_EQ(make_executor(1)->concurrency(), 1);
  EXPECT_EQ(make_executor(3)->concurrency(), 3);
  EXPECT_GE(make_executor(0)->concurrency(), 1);
  EXPECT_EQ(make_executor(0)->concurrency(), default_executor().concurrency());
  EXPECT_THROW(make_executor(-1), std::invalid_argument);
}

TEST(Parallel, TheSerialOneStaysOnTheCallersThreadAndInOrder) {
  std::vector<std::size_t> order;
  const std::thread::id here = std::this_thread::get_id();
  parallel_for(serial_executor(), 0, 10, 3, [&](std::size_t i) {
    EXPECT_EQ(std::this_thread::get_id(), here);
    order.push_back(i);
  });
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(order[i], i);
}

}  // namespace
}  // namespace boxwood
