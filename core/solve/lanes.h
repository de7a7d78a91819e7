// Four doubles at a time, by the compiler's vector extension (g++ 12, clang; AVX2 registers on x86-64-v3).
#pragma once

#include <Eigen/Core>
#include <cstring>

namespace vsgraphs {

using Lanes = double __attribute__((vector_size(32)));
inline constexpr int lane_count = 4;

// Without AVX g++ warns that passing such vectors by value changed between its versions; these are all inlined.
#pragma GCC diagnostic push
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

inline Lanes lanes(double x) { return Lanes{x, x, x, x}; }
inline Lanes max(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes sqrt(Lanes a) {
  using Four = Eigen::Array<double, lane_count, 1>;
  const Four root = Eigen::Map<const Four>(reinterpret_cast<const double*>(&a)).sqrt();
  return Lanes{root[0], root[1], root[2], root[3]};
}
// In a fixed order.
inline double sum(Lanes a) { return (a[0] + a[1]) + (a[2] + a[3]); }

// Memory of any alignment.
inline Lanes load(const double* from) {
  Lanes a;
  std::memcpy(&a, from, sizeof a);
  return a;
}
inline void store(double* to, Lanes a) { std::memcpy(to, &a, sizeof a); }

// Rows become columns: r[k] afterwards holds lane k of the four.
inline void transpose(Lanes r[4]) {
  const Lanes t0 = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6),
              t1 = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
  const Lanes t2 = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6),
              t3 = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
  r[0] = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
  r[1] = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
  r[2] = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
  r[3] = __builtin_shufflevector(t1, t3, 2, 3, 6, 7);
}

#pragma GCC diagnostic pop

}  // namespace vsgraphs
