#include "boxwood/simd/huge_buffer.h"

#include <new>
#include <utility>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace boxwood::simd {
namespace {

constexpr std::size_t kHugePage = std::size_t(2) << 20;

std::align_val_t alignment(std::size_t size) {
  return std::align_val_t(size >= kHugePage ? kHugePage : 64);
}

}  // namespace

HugeBuffer::HugeBuffer(std::size_t size) : size_(size) {
  if (size == 0) return;
  data_ = static_cast<char*>(::operator new(size, alignment(size)));
#if defined(__linux__)
  // A request only: without huge pages everything works, a little slower.
  if (size >= kHugePage) madvise(data_, size, MADV_HUGEPAGE);
#endif
}

HugeBuffer::~HugeBuffer() {
  if (data_) ::operator delete(data_, alignment(size_));
}

HugeBuffer::HugeBuffer(HugeBuffer&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

HugeBuffer& HugeBuffer::operator=(HugeBuffer&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

}  // namespace boxwood::simd
