#include "running.h"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#endif

#include "boxwood/core/error.h"
#include "rows.h"

namespace boxwood::python {
namespace {

constexpr int kMaxThreads = 1024;
constexpr std::chrono::milliseconds kPatience{20};

/// Whether this process is the fork of one that has used workers. They do not come along, what they had
/// locked stays locked, and who waits for them waits for ever: so the fork works alone.
bool is_alone() {
  static std::atomic<bool> is_fork = false;
#if defined(__unix__) || defined(__APPLE__)
  static const int is_watched = pthread_atfork(nullptr, nullptr, [] { is_fork = true; });
  (void)is_watched;
#endif
  return is_fork;
}

}  // namespace

Executor& executor_of(nb::handle argument) {
  const long long threads = read_integer("threads", argument);
  if (threads == 1) return serial_executor();
  if (threads < 0 || threads > kMaxThreads)
    throw std::invalid_argument("threads: got " + repr_of(argument) + ", expected 0 (all) to " +
                                std::to_string(kMaxThreads));
  if (is_alone()) return serial_executor();
  if (threads == 0) return default_executor();
  // Never taken down: at the end of the process others may still be working.
  static std::mutex mutex;
  static auto& executors = *new std::map<long long, std::unique_ptr<Executor>>;
  std::lock_guard lock(mutex);
  std::unique_ptr<Executor>& executor = executors[threads];
  if (!executor) executor = make_executor(static_cast<int>(threads));
  return *executor;
}

bool Signals::keep_going() {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < kPatience) return true;
  last_ = now;
  nb::gil_scoped_acquire gil;
  return PyErr_CheckSignals() == 0;
}

void run_stream(std::size_t count, nb::handle threads, const std::function<void(const Stream&)>& work) {
  Signals signals;
  Stream stream{count, &executor_of(threads), [&signals] { return signals.keep_going(); }};
  try {
    nb::gil_scoped_release no_gil;
    work(stream);
  } catch (const Cancelled&) {
    nb::raise_python_error();
  }
}

void run_in_parts(std::size_t count, nb::handle threads, const Executor::Range& work) {
  constexpr std::size_t kGrain = 4096;
  const std::thread::id caller = std::this_thread::get_id();
  run_stream(count, threads, [&](const Stream& stream) {
    stream.executor->for_range(0, count, kGrain, [&](std::size_t begin, std::size_t end) {
      if (std::this_thread::get_id() == caller && !stream.keep_going()) throw Cancelled();
      work(begin, end);
    });
  });
}

void run_interruptibly(bool is_long, const std::function<void(const Progress&)>& work) {
  if (!is_long) {
    nb::gil_scoped_release no_gil;
    work({});
    return;
  }

  std::atomic<bool> is_stopped = false;
  std::mutex mutex;
  std::condition_variable end;
  bool is_done = false;
  std::exception_ptr error;
  bool was_interrupted = false;
  {
    nb::gil_scoped_release no_gil;
    std::thread worker([&] {
      try {
        work([&](std::string_view, double) { return !is_stopped; });
      } catch (...) {
        error = std::current_exception();
      }
      std::lock_guard lock(mutex);
      is_done = true;
      end.notify_one();
    });
    std::unique_lock lock(mutex);
    while (!end.wait_for(lock, kPatience, [&] { return is_done; })) {
      if (was_interrupted) continue;
      lock.unlock();
      {
        nb::gil_scoped_acquire gil;
        was_interrupted = PyErr_CheckSignals() != 0;
      }
      is_stopped = was_interrupted;
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  if (was_interrupted) nb::raise_python_error();
  if (error) std::rethrow_exception(error);
}

}  // namespace boxwood::python
