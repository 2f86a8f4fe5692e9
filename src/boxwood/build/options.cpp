#include "boxwood/build/options.h"

namespace boxwood {

// The figures behind the presets, with blocks of four (the kernels'): the time to build a whole scene beside
// `balanced`, in thread time, and how many nodes and blocks bounce rays visit in the wide tree, in units of a
// node (a block counts half). Bunny / kitchen / soup / terrain: of a million and 8.4 million triangles for
// the time, of 300,000 and half a million for the visits. docs/performance.md has the times beside Embree's.
//
//     preset      time                        visits
//     fast        0.6 / 0.65 / 0.7 / 0.6      9.7 / 9.4 / 25.1 / 9.2
//     balanced    1                           9.1 / 8.6 / 24.1 / 8.5
//     best        1.15 / 1.3 / 2.6 / 1.1      9.1 / 8.4 / 21.0 / 8.6

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
