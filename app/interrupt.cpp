#include "interrupt.h"

#include <atomic>
#include <csignal>

#include <unistd.h>

namespace boxwood::app {
namespace {

// Set by a signal handler and read by every thread that renders; lock-free, so a handler may touch it.
std::atomic<bool> is_asked_to_stop = false;
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void note_interrupt(int signal) {
  if (is_asked_to_stop.exchange(true)) _exit(128 + signal);  // as shells report it
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, note_interrupt);
  std::signal(SIGTERM, note_interrupt);
}

bool is_interrupted() {
  return is_asked_to_stop;
}

}  // namespace boxwood::app
