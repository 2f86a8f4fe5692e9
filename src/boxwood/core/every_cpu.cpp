#include "boxwood/core/every_cpu.h"

#include <cstdlib>
#include <string_view>

namespace boxwood {
namespace {

LoopCopy best_copy() {
#if defined(__GNUC__) && defined(__x86_64__)
  const char* const wanted = std::getenv("BOXWOOD_TARGET");
  const std::string_view target = wanted != nullptr ? wanted : "";
  const bool is_any = target.empty() || target == "avx512";
  if (is_any && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq"))
    return LoopCopy::avx512;
  if ((is_any || target == "avx2") && __builtin_cpu_supports("avx2")) return LoopCopy::avx2;
#endif
  return LoopCopy::everywhere;
}

}  // namespace

LoopCopy loop_copy() {
  static const LoopCopy copy = best_copy();
  return copy;
}

}  // namespace boxwood
