// embree_settings.h: in which state of the machine is Embree asked?
//
// Only where Embree is compiled in.
#pragma once

#include <pmmintrin.h>
#include <xmmintrin.h>

#include "boxwood/simd/kernels.h"

namespace boxwood::app {

/// Flush-to-zero and denormals-are-zero on this thread, as Embree's manual advises, for as long as this
/// lives.
class DenormalsAreZero {
 public:
  DenormalsAreZero() : before_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  ~DenormalsAreZero() { _mm_setcsr(before_); }
  DenormalsAreZero(const DenormalsAreZero&) = delete;
  DenormalsAreZero& operator=(const DenormalsAreZero&) = delete;

 private:
  unsigned before_;
};

/// What a device is made with: the instruction set that BOXWOOD_TARGET holds our kernels to, where Embree
/// knows it.
inline const char* embree_config() {
  const simd::Kernels* kernels = simd::kernels();
  if (kernels && kernels->name == "avx2") return "isa=avx2";
  if (kernels && kernels->name == "sse4") return "isa=sse4.2";
  return nullptr;
}

}  // namespace boxwood::app
