// Four doubles at a time, by the compiler's vector extension (g++ and clang; AVX2 registers on x86-64-v3).
#pragma once

#include <Eigen/Core>

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
inline Lanes min(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes sqrt(Lanes a) {
  const Eigen::Array<double, lane_count, 1> root = Eigen::Map<const Eigen::Array<double, lane_count, 1>>(
      reinterpret_cast<const double*>(&a)).sqrt();
  return Lanes{root[0], root[1], root[2], root[3]};
}
// In a fixed order: ((0 + 1) + (2 + 3)).
inline double sum(Lanes a) { return (a[0] + a[1]) + (a[2] + a[3]); }

#pragma GCC diagnostic pop

}  // namespace vsgraphs
