#include "boxwood/core/memory_block.h"

#include <cstdint>
#include <map>
#include <mutex>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

// The address sanitizer is to see each array by itself.
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
#define BOXWOOD_HAS_ROOMS 1
#endif

namespace boxwood {
namespace {

constexpr std::size_t kHugePage = std::size_t(2) << 20;

/// Smaller blocks are left to the allocator, which keeps such memory by itself.
constexpr std::size_t kSmallest = std::size_t(1) << 16;

/// What fits into less the allocator keeps from one piece of work to the next.
constexpr std::size_t kSmallestRoom = std::size_t(1) << 26;

constexpr std::size_t round_up(std::size_t value, std::size_t step) {
  return (value + step - 1) / step * step;
}

/// Asks the system to back whole huge pages of [begin, begin + bytes) by such; what it answers does not
/// matter.
void advise_huge_pages([[maybe_unused]] char* begin, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  const auto first = round_up(reinterpret_cast<std::uintptr_t>(begin), kHugePage);
  const auto last = (reinterpret_cast<std::uintptr_t>(begin) + bytes) / kHugePage * kHugePage;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

}  // namespace

#if defined(BOXWOOD_HAS_ROOMS)

/// A range of addresses; its parts are whole pages, so that each can go back to the system by itself.
class MemoryBlock::Room {
 public:
  explicit Room(std::size_t bytes) {
    const std::size_t size = round_up(bytes, kHugePage) + kHugePage;
    void* const begin =
        mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (begin == MAP_FAILED) return;
    const auto address = reinterpret_cast<std::uintptr_t>(begin);
    free_[address] = address + size;
    advise_huge_pages(static_cast<char*>(begin), size);
  }
  ~Room() { close(); }

  /// The lowest place with room for `bytes`; null when there is none.
  char* take(std::size_t bytes, std::size_t alignment) {
    bytes = round_up(bytes, kPage);
    const std::lock_guard lock(mutex_);
    for (auto range = free_.begin(); range != free_.end(); ++range) {
      const auto [begin, end] = *range;
      const std::uintptr_t at = round_up(begin, alignment);
      if (at > end || end - at < bytes) continue;
      free_.erase(range);
      if (begin < at) free_[begin] = at;
      if (at + bytes < end) free_[at + bytes] = end;
      return reinterpret_cast<char*>(at);
    }
    return nullptr;
  }

  void give_back(char* data, std::size_t bytes) {
    std::uintptr_t begin = reinterpret_cast<std::uintptr_t>(data), end = begin + round_up(bytes, kPage);
    const std::lock_guard lock(mutex_);
    if (is_closed_) return unmap(begin, end);

    // Join it with what is free before and behind it.
    auto next = free_.upper_bound(begin);
    if (next != free_.end() && next->first == end) {
      end = next->second;
      next = free_.erase(next);
    }
    if (next != free_.begin() && std::prev(next)->second == begin)
      std::prev(next)->second = end;
    else
      free_[begin] = end;
  }

  /// Gives what is free back to the system, and from now on whatever becomes free.
  void close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    for (const auto& [begin, end] : free_) unmap(begin, end);
    free_.clear();
  }

 private:
  static constexpr std::size_t kPage = 1 << 16;  // or any part of it

  static void unmap(std::uintptr_t begin, std::uintptr_t end) {
    munmap(reinterpret_cast<void*>(begin), end - begin);
  }

  std::mutex mutex_;
  std::map<std::uintptr_t, std::uintptr_t> free_;  ///< Where each free range begins -> its end.
  bool is_closed_ = false;
};

#else

class MemoryBlock::Room {
 public:
  explicit Room(std::size_t) {}
  char* take(std::size_t, std::size_t) { return nullptr; }
  void give_back(char*, std::size_t) {}
  void close() {}
};

#endif

namespace {

thread_local std::shared_ptr<MemoryBlock::Room> current_room;

}  // namespace

MemoryBlock::MemoryBlock(std::size_t size, std::size_t alignment) : size_(size), alignment_(alignment) {
  if (size == 0) return;
  if (current_room && size >= kSmallest) {
    data_ = current_room->take(size, alignment);
    if (data_) room_ = current_room;
  }
  if (data_) return;
  data_ = static_cast<char*>(::operator new(size, std::align_val_t(alignment)));
  advise_huge_pages(data_, size);
}

MemoryBlock::~MemoryBlock() {
  if (!data_) return;
  if (room_)
    room_->give_back(data_, size_);
  else
    ::operator delete(data_, std::align_val_t(alignment_));
}

Workspace::Workspace(std::size_t bytes) : before_(current_room) {
  if (bytes >= kSmallestRoom) room_ = std::make_shared<MemoryBlock::Room>(bytes);
  current_room = room_;
}

Workspace::~Workspace() {
  current_room = std::move(before_);
  if (room_) room_->close();
}

}  // namespace boxwood
