// raw_array.h: where do a million things go that are not made yet?
//
// In memory that nobody has written to. A std::vector writes all of it once before the first use, on one
// thread, which for large scenes is a good part of the time that a build may take. Here a page is touched
// when its first thing is.
#pragma once

#include <cstddef>
#include <type_traits>

#include "boxwood/core/memory_block.h"

namespace boxwood {

/// Room for things that need neither to be made nor to be destroyed. Reading one before it was written is an
/// error.
template <class T>
class RawArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  RawArray() = default;
  explicit RawArray(std::size_t size) : memory_(size * sizeof(T), 64), size_(size) {}
  RawArray(RawArray&& other) noexcept
      : memory_(std::move(other.memory_)), size_(std::exchange(other.size_, 0)) {}
  RawArray& operator=(RawArray&& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(size_, other.size_);
    return *this;
  }

  std::size_t size() const { return size_; }
  T* data() const { return reinterpret_cast<T*>(memory_.data()); }
  T* begin() const { return data(); }
  T* end() const { return data() + size_; }
  T& operator[](std::size_t i) const { return data()[i]; }
  /// Forgets all but the first `size`; the memory stays.
  void shrink(std::size_t size) { size_ = size; }

 private:
  MemoryBlock memory_;
  std::size_t size_ = 0;
};

}  // namespace boxwood
