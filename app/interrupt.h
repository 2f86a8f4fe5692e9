// interrupt.h: what does Ctrl-C do? The first one asks the work to stop and keep what it has; the second one
// ends the program at once.
#pragma once

namespace boxwood::app {

/// From here on Ctrl-C is noted instead of ending the program. Call once, before long work.
void catch_interrupts();

/// Whether Ctrl-C was pressed. Any thread may ask.
bool is_interrupted();

}  // namespace boxwood::app
