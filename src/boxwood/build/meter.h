// meter.h: how far is the build, and was it called off?
#pragma once

#include <atomic>
#include <mutex>

#include "boxwood/core/error.h"
#include "boxwood/core/progress.h"

namespace boxwood {

/// Counts finished work from many threads, and tells the caller's Progress from one at a time.
class Meter {
 public:
  Meter(const Progress& progress, std::size_t total) : progress_(progress), total_(total) {}

  /// Reports `amount` more as done.
  /// Throws Cancelled when the caller wants to stop, now or in an earlier call.
  void advance(std::size_t amount) {
    if (!progress_) return;
    const std::size_t done = done_ += amount;
    if (is_cancelled_) throw Cancelled();

    // Whoever comes while somebody else is telling goes on with its work, but the end is always told.
    std::unique_lock lock(mutex_, std::defer_lock);
    if (done == total_)
      lock.lock();
    else if (!lock.try_lock())
      return;
    if (done <= told_ && told_ > 0) return;
    told_ = done;
    if (!progress_("build", total_ == 0 ? 1.0 : double(done) / double(total_))) is_cancelled_ = true;
    if (is_cancelled_) throw Cancelled();
  }

  /// Reports that all is done, where work turned out to be less than was expected.
  void finish() { advance(total_ - done_); }

 private:
  const Progress& progress_;
  const std::size_t total_;
  std::atomic<std::size_t> done_{0};
  std::atomic<bool> is_cancelled_{false};
  std::mutex mutex_;
  std::size_t told_ = 0;
};

}  // namespace boxwood
