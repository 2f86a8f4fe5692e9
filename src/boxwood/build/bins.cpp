#include "boxwood/build/bins.h"

#include <algorithm>

#include "boxwood/build/morton_order.h"
#include "boxwood/core/every_cpu.h"

namespace boxwood {

#define BOXWOOD_LOOPS "boxwood/build/bins-inl.h"
#include "boxwood/core/every_cpu-inl.h"

Histogram::Histogram(int bin_count) : bins(bin_count) {
  const Slab empty{Lanes::all(-kInfinity), Lanes::all(-kInfinity)};
  for (int i = 0; i < bins; ++i) {
    std::fill_n(slab[i], 3, empty);
    std::fill_n(count[i], 4, 0);
  }
}

const BinKernels& bin_kernels() {
  return BOXWOOD_BEST(kKernels);
}

}  // namespace boxwood
