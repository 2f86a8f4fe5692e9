#include "boxwood/build/options.h"

namespace boxwood {

// The figures behind the presets: one thread, a million boxes of a soup of triangles / of a terrain, on a
// busy machine (docs/performance-log.md). Ratios, not times, carry over.
//
//     method            build, ms        SAH cost
//     longest_axis      1150 /  950      2141 / 45.8
//     binned, 8 bins     620 /  480      1261 / 40.5
//     binned, 16 bins    660 /  500      1246 / 40.4
//     binned, 32 bins    710 /  510      1241 / 40.3
//     sweep             1800 / 1000      1211 / 40.3

// Half the bins: a twentieth less time for a tree that is a hundredth worse.
// The longest axis is worse at both.
BuildOptions BuildOptions::fast() {
  return {.method = Method::ploc};
}

// The knee: more bins cost more than they gain.
BuildOptions BuildOptions::balanced() {
  return {.method = Method::binned_sah, .bins = 16, .reinsertion_rounds = 4, .reinsertion_share = 0.003f};
}

// Every split is looked at: up to a thirtieth better, for two to three times the time.
BuildOptions BuildOptions::best() {
  return {.method = Method::binned_sah,
          .bins = 32,
          .reinsertion_rounds = 8,
          .reinsertion_share = 0.01f,
          .split_share = 0.3f};
}

}  // namespace boxwood
