#include "boxwood/build/options.h"

namespace boxwood {

BuildOptions BuildOptions::fast() {
  return {.method = Method::binned_sah, .bins = 8};
}

BuildOptions BuildOptions::balanced() {
  return {};
}

BuildOptions BuildOptions::best() {
  return {.method = Method::sweep_sah};
}

}  // namespace boxwood
