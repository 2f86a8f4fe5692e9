#include "interrupt.h"

#include <atomic>
#include <csignal>

#include <unistd.h>

namespace boxwood::app {
namespace {

constexpr int kInterruptedExitCode = 128 + SIGINT;  // as shells report it

// Set by a signal handler and read by every thread that renders; lock-free, so a handler may touch it.
std::atomic<bool> is_asked_to_stop = false;
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void note_interrupt(int) {
  if (is_asked_to_stop.exchange(true)) _exit(kInterruptedExitCode);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, note_interrupt);
}

bool is_interrupted() {
  return is_asked_to_stop;
}

}  // namespace boxwood::app
