#include "commands.h"

namespace boxwood::app {
void add_ladder(CLI::App&) {}
}  // namespace boxwood::app
