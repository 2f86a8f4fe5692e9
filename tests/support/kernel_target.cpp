// The tests run once for each instruction set (BOXWOOD_TARGET, tests/CMakeLists.txt). One that this machine
// does not have passes with a notice; a name that is none fails.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include <gtest/gtest.h>

#include "boxwood/simd/kernels.h"

namespace boxwood::test {
namespace {

class KernelTarget final : public ::testing::Environment {
 public:
  void SetUp() override {
    const char* wanted = std::getenv("BOXWOOD_TARGET");
    if (wanted == nullptr) return;
    constexpr std::array<std::string_view, 5> kKnown{"avx512", "avx2", "sse4", "neon", "wasm"};
    const auto all = simd::available_kernels();
    const bool is_here =
        std::any_of(all.begin(), all.end(), [&](const simd::Kernels* k) { return k->name == wanted; });
    if (!is_here && std::find(kKnown.begin(), kKnown.end(), wanted) != kKnown.end())
      GTEST_SKIP() << "This machine cannot run " << wanted << ": nothing to test";
    simd::kernels();  // refuses what is no target
  }
};

[[maybe_unused]] const auto* const kTarget = ::testing::AddGlobalTestEnvironment(new KernelTarget);

}  // namespace
}  // namespace boxwood::test
