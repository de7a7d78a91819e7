// Vectors of bytes and words in the compiler's own notation (GCC and Clang vector extensions): one source for
// every processor, the same results on all of them.
#pragma once

#include <cstdint>
#include <cstring>

namespace vsgraphs::simd {

using U8x16 = std::uint8_t __attribute__((vector_size(16)));
using U8x32 = std::uint8_t __attribute__((vector_size(32)));
using U16x8 = std::uint16_t __attribute__((vector_size(16)));
using U64x4 = std::uint64_t __attribute__((vector_size(32)));

template <typename V, typename T>
inline V load(const T* from) {
  V v;
  std::memcpy(&v, from, sizeof(V));
  return v;
}

template <typename V, typename T>
inline void store(T* to, const V& v) {
  std::memcpy(to, &v, sizeof(V));
}

template <typename V>
inline V min(V a, V b) {
  return a < b ? a : b;
}

template <typename V>
inline V max(V a, V b) {
  return a > b ? a : b;
}

// a - b, 0 where that would be negative.
template <typename V>
inline V minus_saturated(V a, V b) {
  return max(a, b) - b;
}

inline bool any(U8x32 v) {
  const U64x4 w = reinterpret_cast<U64x4>(v);
  return (w[0] | w[1] | w[2] | w[3]) != 0;
}

}  // namespace vsgraphs::simd
