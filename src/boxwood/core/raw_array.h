// raw_array.h: where do a million things go that are not made yet?
//
// In memory that nobody has written to. A std::vector writes all of it once before the first use, on one
// thread, which for large scenes is a good part of the time that a build may take. Here a page is touched
// when its first thing is.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

namespace boxwood {

/// Asks the system to back `bytes` from `begin` on by huge pages, where it knows such a thing.
void advise_huge_pages(void* begin, std::size_t bytes);

/// Room for things that need neither to be made nor to be destroyed. Reading one before it was written is an
/// error.
template <class T>
class RawArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  RawArray() = default;
  explicit RawArray(std::size_t size) : size_(size) {
    if (size == 0) return;
    const std::size_t bytes = size * sizeof(T);
    memory_.reset(static_cast<T*>(::operator new(bytes, kAlignment)));
    advise_huge_pages(memory_.get(), bytes);
  }

  std::size_t size() const { return size_; }
  T* data() const { return memory_.get(); }
  T* begin() const { return data(); }
  T* end() const { return data() + size_; }
  T& operator[](std::size_t i) const { return data()[i]; }
  /// Forgets all but the first `size`; the memory stays.
  void shrink(std::size_t size) { size_ = size; }

 private:
  static constexpr std::align_val_t kAlignment{64};
  struct Free {
    void operator()(T* memory) const { ::operator delete(memory, kAlignment); }
  };
  std::unique_ptr<T, Free> memory_;
  std::size_t size_ = 0;
};

}  // namespace boxwood
