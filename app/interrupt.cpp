#include "interrupt.h"

#include <csignal>

#include <unistd.h>

namespace boxwood::app {
namespace {

constexpr int kInterruptedExitCode = 128 + SIGINT;  // as shells report it
volatile std::sig_atomic_t interrupts = 0;

extern "C" void note_interrupt(int) {
  if (interrupts != 0) _exit(kInterruptedExitCode);
  interrupts = 1;
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, note_interrupt);
}

bool is_interrupted() {
  return interrupts != 0;
}

}  // namespace boxwood::app
