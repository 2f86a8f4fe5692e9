// What a build allocates, counted, against what was announced.
#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>
#include <malloc.h>

#include "boxwood/build/build.h"
#include "support/box_sets.h"

namespace {

std::atomic<std::size_t> in_use{0}, peak{0};

void* allocate(std::size_t bytes, std::size_t alignment) {
  // Aligned memory comes from a multiple of the alignment.
  void* memory = std::aligned_alloc(alignment, (bytes + alignment) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t now = in_use += malloc_usable_size(memory);
  std::size_t seen = peak;
  while (seen < now && !peak.compare_exchange_weak(seen, now)) {
  }
  return memory;
}
void release(void* memory) {
  in_use -= malloc_usable_size(memory);
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t bytes) {
  return allocate(bytes, 16);
}
void* operator new[](std::size_t bytes) {
  return allocate(bytes, 16);
}
void* operator new(std::size_t bytes, std::align_val_t a) {
  return allocate(bytes, std::size_t(a));
}
void* operator new[](std::size_t bytes, std::align_val_t a) {
  return allocate(bytes, std::size_t(a));
}
// The standard library asks for room that it can do without by this one (std::stable_partition).
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  try {
    return allocate(bytes, 16);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* memory) noexcept {
  release(memory);
}
void operator delete[](void* memory) noexcept {
  release(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}

namespace boxwood {
namespace {

std::vector<BuildOptions> every_way() {
  std::vector<BuildOptions> ways{BuildOptions::fast(), BuildOptions::balanced()};
  for (const Method method : {Method::longest_axis, Method::binned_sah, Method::sweep_sah, Method::ploc})
    for (const int leaf_size : {1, 4})
      for (const int block_size : {1, 4})
        ways.push_back({.method = method, .leaf_size = leaf_size, .block_size = block_size});
  return ways;
}

std::size_t peak_of_build(const std::vector<Box3>& boxes, const BuildOptions& options) {
  const std::size_t before = in_use;
  peak = before;
  const Bvh bvh = build(boxes, options);
  return peak - before;
}

TEST(Memory, IsNoMoreThanAnnouncedAndAtLeastHalf) {
  const auto four = make_executor(4);
  for (const auto& boxes : {test::soup_boxes(20'000), test::soup_boxes(300'000), test::terrain_boxes(200)})
    for (BuildOptions options : every_way())
      for (Executor* executor : {&serial_executor(), four.get()}) {
        options.executor = executor;
        const std::size_t found = peak_of_build(boxes, options);
        const std::size_t announced = build_memory_bytes(boxes.size(), options);
        EXPECT_LE(found, announced) << int(options.method) << ", leaf size " << options.leaf_size;
        EXPECT_LE(announced, 2 * found) << int(options.method) << ", leaf size " << options.leaf_size
                                        << ", block size " << options.block_size << ", " << boxes.size();
      }
}

TEST(Memory, AnnouncementsHoldForHardSets) {
  for (const test::BoxSet& set : test::box_sets())
    for (BuildOptions options : every_way()) {
      options.executor = &serial_executor();
      EXPECT_LE(peak_of_build(set.boxes, options), build_memory_bytes(set.boxes.size(), options)) << set.name;
    }
}

TEST(Memory, SpatialSplitsAreAnnouncedToo) {
  const std::vector<Box3> boxes = test::soup_boxes(100'000);
  const Clip clip = [&](PrimId id, const Box3& region) { return intersect(boxes[id.value], region); };
  BuildOptions options = BuildOptions::best();
  options.executor = &serial_executor();
  const std::size_t before = in_use;
  peak = before;
  const Bvh bvh = build(boxes, clip, options);
  const std::size_t announced = build_memory_bytes(boxes.size(), options);
  EXPECT_LE(peak - before, announced);
  EXPECT_LE(announced, 2 * (peak - before));
}

}  // namespace
}  // namespace boxwood
