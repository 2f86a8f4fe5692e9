// Blocks of one workspace: apart from each other, and one after the other in the same place.
#include "boxwood/core/memory_block.h"

#include <cstdint>
#include <cstring>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "boxwood/core/raw_array.h"

namespace boxwood {
namespace {

constexpr std::size_t kMegabyte = 1 << 20;

bool is_full_of(const MemoryBlock& block, int value) {
  for (std::size_t i = 0; i < block.size(); ++i)
    if (block.data()[i] != static_cast<char>(value)) return false;
  return true;
}

TEST(Workspace, BlocksDoNotOverlap) {
  const Workspace workspace(64 * kMegabyte);
  // Take and let go in a wild order; each block keeps what was written to it. The last do not fit.
  std::vector<MemoryBlock> blocks;
  std::vector<int> values;
  std::uint32_t state = 1;
  for (int step = 0; step < 300; ++step) {
    state = state * 1664525 + 1013904223;
    if (step % 3 == 2) {
      const std::size_t i = state % blocks.size();
      EXPECT_TRUE(is_full_of(blocks[i], values[i])) << "at step " << step;
      blocks.erase(blocks.begin() + std::ptrdiff_t(i));
      values.erase(values.begin() + std::ptrdiff_t(i));
    } else {
      const std::size_t alignment = step % 2 ? 64 : 2 * kMegabyte;
      blocks.emplace_back(kMegabyte / 2 + state % kMegabyte, alignment);
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(blocks.back().data()) % alignment, 0u);
      std::memset(blocks.back().data(), step, blocks.back().size());
      values.push_back(step);
    }
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) EXPECT_TRUE(is_full_of(blocks[i], values[i]));
}

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
TEST(Workspace, HandsOutWhatWasLetGo) {
  const Workspace workspace(64 * kMegabyte);
  RawArray<int> first(kMegabyte);
  const RawArray<int> second(kMegabyte);
  const int* const place = first.data();
  first = {};
  const RawArray<char> third(3 * kMegabyte);
  EXPECT_EQ(reinterpret_cast<const char*>(place), third.data());

  // One inside has a place of its own, until it ends.
  {
    const Workspace inner(64 * kMegabyte);
    const RawArray<char> other(kMegabyte);
    EXPECT_TRUE(other.data() < third.data() - 64 * kMegabyte || other.data() > third.data() + 64 * kMegabyte);
  }
  const RawArray<char> fourth(kMegabyte / 2);
  EXPECT_EQ(third.data() + 3 * kMegabyte, fourth.data());
}
#endif

TEST(Workspace, BlocksOutliveIt) {
  MemoryBlock kept, dropped;
  {
    const Workspace workspace(64 * kMegabyte);
    dropped = MemoryBlock(3 * kMegabyte, 64);
    kept = MemoryBlock(3 * kMegabyte, 64);
    std::memset(kept.data(), 7, kept.size());
  }
  std::thread([block = std::move(dropped)] {}).join();
  EXPECT_TRUE(is_full_of(kept, 7));
  const MemoryBlock later(kMegabyte, 64);
  std::memset(later.data(), 1, later.size());
  EXPECT_TRUE(is_full_of(kept, 7));
}

}  // namespace
}  // namespace boxwood
