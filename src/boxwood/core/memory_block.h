// memory_block.h: where does the memory of a large array come from?
//
// From the system, which clears every page that it hands out: in a build, whose steps each fill an array and
// let another go, that took up to half of the time. So whoever does such work opens a Workspace: as long as
// it lives, the large arrays of its thread lie in one range of addresses, each at the lowest place that is
// free, on pages that the steps before have touched already.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

namespace boxwood {

/// Bytes that nobody has written to, or that somebody has let go; can be moved but not copied.
class MemoryBlock {
 public:
  class Room;

  MemoryBlock() = default;
  /// `alignment`: a power of two, at least 64. Throws std::bad_alloc.
  MemoryBlock(std::size_t size, std::size_t alignment);
  ~MemoryBlock();
  MemoryBlock(MemoryBlock&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)),
        size_(std::exchange(other.size_, 0)),
        alignment_(other.alignment_),
        room_(std::move(other.room_)) {}
  MemoryBlock& operator=(MemoryBlock&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(alignment_, other.alignment_);
    std::swap(room_, other.room_);
    return *this;
  }

  char* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  char* data_ = nullptr;
  std::size_t size_ = 0, alignment_ = 0;
  std::shared_ptr<Room> room_;  ///< Null when it came from the system directly.
};

/// While one lives, large blocks that its thread asks for share its room. Blocks may outlive it, and may be
/// let go by any thread; what is free when it ends goes back to the system. A second one on the same thread
/// takes the place of the first until it ends.
class Workspace {
 public:
  /// At most `bytes` at a time; what does not fit comes from the system as ever. An address range of that
  /// size is reserved, no memory. Does nothing where it would not pay, or the system offers no such thing.
  explicit Workspace(std::size_t bytes);
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

 private:
  std::shared_ptr<MemoryBlock::Room> room_, before_;
};

}  // namespace boxwood
