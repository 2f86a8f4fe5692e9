// every_cpu-inl.h: how is one file of loops compiled for every CPU, and once more for better ones?
//
// BOXWOOD_LOOPS names the file. What it holds comes out as everywhere:: and, where the compiler can do that
// in one go, as avx2:: (elsewhere these are the same). No fused multiply-add: it would give other bits.
// Included inside namespace boxwood; no include guard.

namespace everywhere {
#include BOXWOOD_LOOPS
}

#if defined(__GNUC__) && defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
#include BOXWOOD_LOOPS
}
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
/// Whether this CPU runs what avx2:: holds.
inline bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2");
  return has;
}
#else
namespace avx2 = everywhere;
inline bool has_avx2() {
  return false;
}
#endif
