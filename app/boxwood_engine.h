// boxwood_engine.h: how does Boxwood itself stand on the bench? As a user would call it: through Scene.
#pragma once

#include "bench_engine.h"

namespace boxwood::app {

/// Modes single (a call for each ray) and batch (spans of rays); presets fast, balanced, best and
/// compact (balanced, in the compact layout).
std::unique_ptr<Engine> boxwood_engine();

}  // namespace boxwood::app
