#include "boxwood/build/options.h"

namespace boxwood {

// The figures behind the presets, as ratios to Embree 3.13's MEDIUM in one process, one thread, block_size 4
// (the kernels'): how many times as fast the tree is built, and how many nodes and blocks bounce rays visit
// in the wide tree, in units of a node (a block counts half). Bunny / kitchen / soup of a million / terrain
// of half a million triangles; docs/performance-log.md says more.
//
//     preset      build                       visits
//     fast        3.3 / 2.8 / 4.1 / 3.5       13.0 / 4.6 / 35.6 / 7.5
//     balanced    2.0 / 1.5 / 2.5 / 1.8       12.0 / 4.4 / 34.4 / 6.8
//     best        0.8 / 0.47 / 0.64 / 0.56    11.8 / 4.2 / 26.7 / 6.8     (HIGH: 0.16 / 0.44 / 0.30 / 0.46)

// Linear in the primitives, and in rooms even better than bins alone.
BuildOptions BuildOptions::fast() {
  return {.method = Method::ploc};
}

// 16 bins are the knee. Reinsertion takes a tenth of the time, and where large and small things mix a third
// off the visits.
BuildOptions BuildOptions::balanced() {
  return {.method = Method::binned_sah, .bins = 16, .reinsertion_rounds = 4, .reinsertion_share = 0.003f};
}

// More of everything; spatial splits where the caller has a clip function. A sweep gains another 4% on some
// meshes, for three times the time.
BuildOptions BuildOptions::best() {
  return {.method = Method::binned_sah,
          .bins = 32,
          .reinsertion_rounds = 8,
          .reinsertion_share = 0.01f,
          .split_share = 0.15f};
}

}  // namespace boxwood
