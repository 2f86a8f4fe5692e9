// every_cpu.h: which copy of a loop does this CPU run best?
//
// Loops that compilers turn into vector instructions stand in files *-inl.h and are compiled several times by
// every_cpu-inl.h.
#pragma once

namespace boxwood {

enum class LoopCopy { everywhere, avx2, avx512 };

/// The best one, or a lesser one that the environment variable BOXWOOD_TARGET names (see simd/kernels.h);
/// all give the same bits. Reads the variable once.
LoopCopy loop_copy();

}  // namespace boxwood
