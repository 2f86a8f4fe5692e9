// wasm_compat.h: what of C++20's library does an old libc++ lack that src/ uses? Included first of all, where
// Emscripten compiles (wasm.cmake); empty where the library is complete.
#pragma once

#include <bit>
#include <memory>

#if !defined(__cpp_lib_bit_cast)
namespace std {
template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}
}  // namespace std
#endif

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 16000
namespace std {
template <class Array>
unique_ptr<Array> make_unique_for_overwrite(size_t count) {
  return unique_ptr<Array>(new remove_extent_t<Array>[count]);
}
}  // namespace std
#endif
