// past_cache.h: how is memory written that is not read again soon?
//
// A store fetches the line that it changes, and the line drives another out of the cache: for tens of
// megabytes of answers that is twice the traffic, and the tree pays with what it had in the cache. x86 can
// write whole vectors to memory past all that. Elsewhere these are ordinary copies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace boxwood::python {

/// Copies `count` numbers of four bytes. Other threads may look after finish_past_cache on this one.
template <class T>
void copy_past_cache(T* to, const T* from, std::size_t count) {
  static_assert(sizeof(T) == 4);
#ifdef __SSE2__
  constexpr std::size_t kLanes = 4, kBytes = 16;
  for (; count > 0 && reinterpret_cast<std::uintptr_t>(to) % kBytes != 0; --count) *to++ = *from++;
  for (; count >= kLanes; count -= kLanes, to += kLanes, from += kLanes)
    _mm_stream_si128(reinterpret_cast<__m128i*>(to), _mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
#endif
  std::memcpy(to, from, count * sizeof(T));
}

inline void finish_past_cache() {
#ifdef __SSE2__
  _mm_sfence();
#endif
}

}  // namespace boxwood::python
