// prefetch.h: how is memory asked for before it is needed?
#pragma once

namespace boxwood {

/// Asks for the cache line of `p`, which may be any address.
inline void prefetch([[maybe_unused]] const void* p) {
#if defined(__GNUC__)
  __builtin_prefetch(p);
#endif
}

}  // namespace boxwood
