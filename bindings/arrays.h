// Numpy arrays from the core's values; each owns its memory.
#pragma once

#include <nanobind/ndarray.h>

#include <memory>
#include <vector>

#include "core/geometry/se3.h"

namespace vsgraphs {

template <typename T>
using NumpyArray = nanobind::ndarray<nanobind::numpy, T>;

// Takes over `values`; their number must be the product of `shape`.
template <typename T>
NumpyArray<T> to_numpy(std::vector<T> values, std::initializer_list<std::size_t> shape) {
  auto owned = std::make_unique<std::vector<T>>(std::move(values));
  T* data = owned->data();
  nanobind::capsule owner(owned.release(), [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return NumpyArray<T>(data, shape, owner);
}

// Appends a 4x4 matrix row by row.
inline void append_rows(std::vector<double>& out, const Se3& pose) {
  const Eigen::Matrix4d m = pose.matrix();
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) out.push_back(m(r, c));
}

}  // namespace vsgraphs
