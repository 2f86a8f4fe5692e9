#include "boxwood/build/bins.h"

#include <algorithm>

#include "boxwood/build/morton_order.h"

// Once for every CPU.
namespace boxwood {
namespace everywhere {
#include "boxwood/build/bins-inl.h"
}
}  // namespace boxwood

// Once for those with AVX2, where the compiler can do that in one file. No fused multiply-add: it would give
// other bits.
#if defined(__GNUC__) && defined(__x86_64__)
#define BOXWOOD_BINS_AVX2 1
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace boxwood {
namespace avx2 {
#include "boxwood/build/bins-inl.h"
}
}  // namespace boxwood
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

namespace boxwood {

Histogram::Histogram(int bin_count) : bins(bin_count) {
  const Slab empty{Lanes::all(-kInfinity), Lanes::all(-kInfinity)};
  for (int i = 0; i < bins; ++i) {
    std::fill_n(slab[i], 3, empty);
    std::fill_n(count[i], 4, 0);
  }
}

const BinKernels& bin_kernels() {
#if defined(BOXWOOD_BINS_AVX2)
  static const BinKernels& kernels = __builtin_cpu_supports("avx2") ? avx2::kKernels : everywhere::kKernels;
  return kernels;
#else
  return everywhere::kKernels;
#endif
}

}  // namespace boxwood
