// huge_buffer.h: where does a large tree live?
//
// In one block of memory, aligned to a cache line; from two megabytes on it is aligned to a huge page and the
// system is asked to back it by huge pages, because a traversal jumps about and would miss the TLB at every
// step.
#pragma once

#include <cstddef>

namespace boxwood::simd {

/// A block of bytes that can be moved but not copied; nobody has written to it yet.
class HugeBuffer {
 public:
  HugeBuffer() = default;
  /// Throws std::bad_alloc.
  explicit HugeBuffer(std::size_t size);
  ~HugeBuffer();
  HugeBuffer(HugeBuffer&& other) noexcept;
  HugeBuffer& operator=(HugeBuffer&& other) noexcept;

  char* data() { return data_; }
  const char* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace boxwood::simd
