// embree_peer.h: how does Intel Embree stand on the bench? The only file of the program that knows Embree;
// where Embree was not found when the program was configured, it has nothing to offer.
//
// As its manual advises, denormals are flushed and taken as zero while it traces (it sees to that by itself
// while it builds); rays and hits stay in its own structures, the mesh in buffers shared with the caller.
#pragma once

#include "bench_engine.h"

namespace boxwood::app {

/// Engines "embree" (its default, which may let rays slip through edges) and "embree-robust"; none without
/// Embree. Modes single and packet16; presets low, medium and high, of robust only medium. They build with
/// oneTBB, so one build limits the whole process to its number of threads while it runs.
std::vector<std::unique_ptr<Engine>> embree_engines();

/// "3.13.5", or empty without Embree.
std::string embree_version();

}  // namespace boxwood::app
