// every_cpu-inl.h: how is one file of loops compiled for every CPU, and again for better ones?
//
// BOXWOOD_LOOPS names the file. What it holds comes out as everywhere:: and, where the compiler can do that
// in one go, as avx2:: and avx512:: (elsewhere these are the same); BOXWOOD_BEST(name) is the copy that this
// CPU runs best. No fused multiply-add: it would give other bits. Included inside namespace boxwood, behind
// every_cpu.h; no include guard.

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
#pragma clang attribute push(__attribute__((target("avx2,avx512f,avx512vl,avx512bw,avx512dq"))), \
                             apply_to = function)
#else
#pragma GCC target("avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512")
#endif
namespace avx512 {
#include BOXWOOD_LOOPS
}
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#else
namespace avx2 = everywhere;
namespace avx512 = everywhere;
#endif

#undef BOXWOOD_BEST
#define BOXWOOD_BEST(name)                        \
  (loop_copy() == LoopCopy::avx512 ? avx512::name \
   : loop_copy() == LoopCopy::avx2 ? avx2::name   \
                                   : everywhere::name)
