// interrupt.h: what does Ctrl-C do? The first one asks the work to stop and keep what it has; the second one
// ends the program at once. So does SIGTERM, by which farms and mpirun ask a program to end.
#pragma once

namespace boxwood::app {

/// From here on Ctrl-C (or SIGTERM) is noted instead of ending the program. Call once, before long work.
void catch_interrupts();

/// Whether it came. Any thread may ask.
bool is_interrupted();

}  // namespace boxwood::app
